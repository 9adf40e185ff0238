#!/usr/bin/env python3
"""What the node cannot run: it names the fault and ends with exit status 1."""
import os
import re
import signal
import socket
import subprocess
import tempfile
import unittest

import rospy
import rostest
import yaml

from aligner_test_case import program, scene_path


def start(*arguments):
    """Exit status and log of a node that is to end by itself."""
    process = subprocess.run((program('aligner_node'), '__name:=bad') + arguments,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=20, universal_newlines=True)
    return process.returncode, process.stdout


class BadStart(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        rospy.init_node('test_bad_start')

    def setUp(self):
        if rospy.has_param('/bad'):
            rospy.delete_param('/bad')
        with open(scene_path('small')) as file:
            self.scene = yaml.safe_load(file)

    def assert_refused(self, *parts, arguments=()):
        status, log = start(*arguments)
        self.assertEqual(status, 1, log)
        self.assertIn('FATAL', log)
        for part in parts:
            self.assertIn(part, log)

    def test_no_parameters(self):
        self.assert_refused('/bad/scene', 'no scene', '/bad/scene_file')

    def test_all_faults_of_a_scene_at_once(self):
        del self.scene['base']
        self.scene['part']['half_width'] = -1.0
        self.scene['slot']['clearence'] = 0.1
        rospy.set_param('/bad/scene', self.scene)
        self.assert_refused('/bad/scene: part.half_width', '-1', 'clearence', 'base.stiffness')

    def test_nan_in_the_scene(self):
        self.scene['gripper']['pressing_force'] = float('nan')
        rospy.set_param('/bad/scene', self.scene)
        self.assert_refused('gripper.pressing_force')

    def test_scene_that_is_no_tree(self):
        rospy.set_param('/bad/scene', 'fig2')
        self.assert_refused('/bad/scene')

    def test_missing_file(self):
        self.assert_refused('/no/such/scene.yaml', arguments=('_scene_file:=/no/such/scene.yaml',))

    def test_empty_name_of_the_file(self):
        self.assert_refused('/bad/scene_file', arguments=('_scene_file:=',))

    def test_name_that_is_none(self):
        status, log = start('__name:=a-b')
        self.assertEqual(status, 1, log)
        self.assertIn('a-b', log)

    def test_empty_and_binary_file(self):
        for content in (b'', b'\x7fELF\x00\x01\xff\xfe' * 20):
            with tempfile.NamedTemporaryFile(suffix='.yaml') as file:
                file.write(content)
                file.flush()
                self.assert_refused(file.name, arguments=('_scene_file:=' + file.name,))

    def test_tree_and_file(self):
        rospy.set_param('/bad/scene', self.scene)
        self.assert_refused('both', arguments=('_scene_file:=' + scene_path('small'),))

    def test_start_beyond_the_base(self):
        self.scene['initial']['x'] = 1000.0
        rospy.set_param('/bad/scene', self.scene)
        self.assert_refused('initial')

    def test_parameters_of_the_node(self):
        for name, value in (('time_scale', -1.0), ('time_scale', float('nan')), ('publish_rate', 0),
                            ('autostart', 'maybe'), ('slot_position', [1, 2]), ('wait_for_subscribers', 'nonsense'),
                            ('feedback_rate', 0), ('publish_clock', 'yes'),
                            ('publish_clock', True), ('publish_rate', 1e-308), ('sample_interval', 1e308)):
            rospy.set_param('/bad/scene', self.scene)
            rospy.set_param('/bad/' + name, value)
            self.assert_refused('/bad/' + name)
            rospy.delete_param('/bad')

    def test_more_samples_than_ever_end(self):
        rospy.set_param('/bad', {'scene': self.scene, 'sample_interval': 1e-12, 'time_scale': 0})
        self.assert_refused('/bad/sample_interval: ', 'must be', 'at least', '1e9 samples')

    def test_unknown_parameters_are_named(self):
        rospy.set_param('/bad', {'scene': self.scene, 'time_scale': -1.0, 'publish_rat': 50.0, 'colour': 'red',
                                 'amplitude': 1.0, 'align': {'status_list_timeout': 5.0}})
        _, log = start()
        warned = re.findall(r'WARN.*unknown parameter (\S+) is not read(.*)', log)
        self.assertEqual([(name, 'publish_rate' in rest) for name, rest in warned],
                         [('/bad/colour', False), ('/bad/publish_rat', True)], log)

    def test_prefix_that_makes_no_frame(self):
        for prefix in ('left arm', '/left', 'left/', 'left//arm', 'a:b'):
            rospy.set_param('/bad', {'scene': self.scene, 'tf_prefix': prefix})
            self.assert_refused('/bad/tf_prefix: %s: must be' % prefix)

    def test_nan_and_infinity_in_every_number(self):
        numbers = ('time_scale', 'publish_rate', 'sample_interval', 'linger', 'feedback_rate')
        for value in (float('nan'), float('inf'), float('-inf')):
            rospy.set_param('/bad/scene', self.scene)
            for name in numbers:
                rospy.set_param('/bad/' + name, value)
            rospy.set_param('/bad/slot_position', [0.0, value, 0.0])
            self.assert_refused(*('/bad/%s: ' % name for name in numbers + ('slot_position',)))

    def test_without_a_master_it_waits_and_can_be_ended(self):
        with socket.socket() as nobody:  # a port at which no master answers
            nobody.bind(('localhost', 0))
            environment = dict(os.environ, ROS_MASTER_URI='http://localhost:%d' % nobody.getsockname()[1])
            for number in (signal.SIGINT, signal.SIGTERM):
                for arguments in ((), ('_scene_file:=' + scene_path('small'),)):  # roscpp waits at two places
                    process = subprocess.Popen((program('aligner_node'), '__name:=bad') + arguments, env=environment,
                                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                    self.addCleanup(process.kill)
                    with self.assertRaises(subprocess.TimeoutExpired):
                        process.wait(timeout=1.0)
                    process.send_signal(number)
                    self.assertEqual(process.wait(timeout=5.0), 0)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'bad_start', BadStart)
