#!/usr/bin/env python3
"""The master is killed while a trial runs. A master of its own: rostest needs its own one."""
import os
import signal
import socket
import subprocess
import time
import unittest

import rostest

from aligner_test_case import scene_path


class LostMaster(unittest.TestCase):

    def setUp(self):
        with socket.socket() as probe:
            probe.bind(('', 0))
            port = probe.getsockname()[1]
        self.environment = dict(os.environ, ROS_MASTER_URI='http://localhost:%d' % port)
        self.master = self.spawn('rosmaster', '--core', '-p', str(port))
        deadline = time.time() + 15.0
        while socket.socket().connect_ex(('localhost', port)) != 0:
            self.assertLess(time.time(), deadline, 'no master')
            time.sleep(0.1)

    def spawn(self, *command):
        process = subprocess.Popen(command, env=self.environment)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def start_node(self, *arguments):
        find = ('catkin_find', '--first-only', '--libexec', 'vibratory_alignment', 'aligner_node')
        node = subprocess.check_output(find, universal_newlines=True).strip()
        return self.spawn(node, '_scene_file:=' + scene_path('small'), '_sample_interval:=0.01', *arguments)

    def test_trial_goes_on_to_its_end(self):
        node = self.start_node('_time_scale:=0.005', '_exit_when_done:=true', '_linger:=0')  # 3 s
        time.sleep(1.5)
        self.assertIsNone(node.poll())
        self.master.kill()
        self.assertEqual(node.wait(10.0), 0)

    def test_interrupt_ends_it_at_once(self):
        node = self.start_node('_time_scale:=0.0005')
        time.sleep(1.0)
        self.master.kill()
        time.sleep(1.0)
        self.assertIsNone(node.poll(), 'it goes on')
        node.send_signal(signal.SIGINT)
        start = time.time()
        self.assertEqual(node.wait(5.0), 0)
        self.assertLess(time.time() - start, 1.0)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'lost_master', LostMaster)
