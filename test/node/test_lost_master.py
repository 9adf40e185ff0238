#!/usr/bin/env python3
"""The master is killed while a trial runs, and returns. A master of its own: rostest needs its own one."""
import os
import signal
import socket
import subprocess
import sys
import time
import unittest

import rosgraph
import rostest

from aligner_test_case import scene_path


class LostMaster(unittest.TestCase):

    def setUp(self):
        with socket.socket() as probe:
            probe.bind(('', 0))
            port = probe.getsockname()[1]
        self.environment = dict(os.environ, ROS_MASTER_URI='http://localhost:%d' % port)
        self.port = port
        self.start_master()

    def start_master(self, pid=None):
        """With `pid` it says that it has this one, as every master in a container of its own does."""
        disguise = 'import os, rosmaster; os.getpid = lambda: %s; rosmaster.rosmaster_main()' % pid
        program = ['rosmaster'] if pid is None else [sys.executable, '-c', disguise]
        self.master = self.spawn(*program, '--core', '-p', str(self.port))
        self.wait_until(lambda: socket.socket().connect_ex(('localhost', self.port)) == 0, 'no master')

    def replace_master(self, pid=None):
        self.master.kill()
        self.master.wait()
        self.start_master(pid)

    def wait_until(self, condition, message, seconds=40.0):
        deadline = time.time() + seconds
        while not condition():
            self.assertLess(time.time(), deadline, message)
            time.sleep(0.1)

    def registered(self):
        """Topics and services that the master knows of the node."""
        master = rosgraph.Master('/test_lost_master', master_uri=self.environment['ROS_MASTER_URI'])
        return {name for entries in master.getSystemState() for name, nodes in entries if '/aligner' in nodes}

    def ask(self, *command):
        """Output of a tool of ROS; empty if it fails."""
        return subprocess.run(command, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              universal_newlines=True).stdout

    def spawn(self, *command, **options):
        process = subprocess.Popen(command, env=self.environment, **options)
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

    def test_ends_beside_a_master_that_does_not_answer(self):
        node = self.start_node('_time_scale:=0.0005')
        self.wait_until(lambda: '/aligner/step' in self.registered(), 'not registered')
        self.addCleanup(self.master.send_signal, signal.SIGCONT)
        self.master.send_signal(signal.SIGSTOP)
        time.sleep(2.5)
        node.send_signal(signal.SIGINT)
        self.assertEqual(node.wait(5.0), 0)

    def test_master_that_goes_while_the_node_starts_stops_nothing(self):
        for delay in (0.02, 0.05, 0.1, 0.15, 0.2):
            node = self.start_node('_time_scale:=0.0005', '_autostart:=false')
            time.sleep(delay)
            self.master.kill()
            self.master.wait()
            time.sleep(1.0)
            node.send_signal(signal.SIGINT)
            self.assertIn(node.wait(5.0), (0, 1), delay)  # 1: there was no master to read the parameters from
            self.start_master()

    def test_new_master_while_the_node_starts_knows_all_of_it(self):
        self.replace_master(pid=1)
        node = self.start_node('_time_scale:=0.0005', '_autostart:=false')
        while '/aligner/set_parameters' not in self.registered():
            self.assertIsNone(node.poll())
        node.send_signal(signal.SIGSTOP)  # the rest it tells the next one
        self.replace_master(pid=1)
        node.send_signal(signal.SIGCONT)
        self.wait_until(lambda: {'/aligner/get_loggers', '/aligner/set_parameters', '/aligner/align/goal',
                                 '/aligner/step'} <= self.registered(), 'not all is registered')

    def test_new_master_knows_all_of_the_node(self):
        node = self.start_node('_time_scale:=0.0005', '_autostart:=false')
        self.wait_until(lambda: {'/aligner/set_parameters', '/aligner/align/goal', '/diagnostics'} <= self.registered(),
                        'not registered')
        before = self.registered()
        self.master.kill()
        self.master.wait()
        time.sleep(1.5)
        self.start_master()
        self.wait_until(lambda: self.registered() >= before, 'not all is registered again')
        self.assertIn('success: True', self.ask('rosservice', 'call', '/aligner/step'))
        # topics work in both directions
        echo = self.spawn('rostopic', 'echo', '-n', '1', '/aligner/align/result', stdout=subprocess.PIPE)
        time.sleep(1.5)
        self.spawn('rostopic', 'pub', '-1', '/aligner/align/goal', 'vibratory_alignment/AlignActionGoal',
                   '{goal: {time_limit: -1.0}}')
        self.assertIn('time_limit: -1: must be', echo.communicate(timeout=10.0)[0].decode())
        self.assertIsNone(node.poll())

    def test_new_master_with_the_process_number_of_the_old_one(self):
        self.replace_master(pid=1)
        self.start_node('_time_scale:=0.0005', '_autostart:=false')
        self.wait_until(lambda: {'/aligner/set_parameters', '/aligner/state'} <= self.registered(), 'not registered')
        before = self.registered()
        self.replace_master(pid=1)
        self.wait_until(lambda: self.registered() >= before, 'not all is registered again', 15.0)

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
