#!/usr/bin/env python3
"""A bag from a live trial and one from `align trial --bag`."""
import os
import subprocess
import tempfile
import unittest

import rosbag
import rostest

from aligner_test_case import align, scene_path

TOPICS = ['contacts', 'markers', 'reaction/a1', 'reaction/a2', 'result', 'state']


class Record(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.live = os.path.join(cls.directory.name, 'live.bag')
        cls.offline = os.path.join(cls.directory.name, 'offline.bag')
        subprocess.check_call(['roslaunch', 'vibratory_alignment', 'trial.launch', 'scene:=' + scene_path('small'),
                               'rviz:=false', 'record:=' + cls.live, 'sample_interval:=0.01', 'time_scale:=0.01',
                               'exit_when_done:=true'])
        align('trial', scene_path('small'), '--bag', cls.offline, '--sample', '0.01')

    @classmethod
    def tearDownClass(cls):
        cls.directory.cleanup()

    @staticmethod
    def messages(path, topic):
        with rosbag.Bag(path) as bag:
            return [message for _, message, _ in bag.read_messages(topics=[topic])]

    def test_both_hold_the_topics_of_the_node(self):
        for path in (self.live, self.offline):
            with rosbag.Bag(path) as bag:
                topics = bag.get_type_and_topic_info().topics
            self.assertLessEqual({'/aligner/' + topic for topic in TOPICS} | {'/tf', '/tf_static'}, set(topics))

    def test_live_bag_is_whole(self):
        self.assertEqual(os.path.exists(self.live + '.active'), False)
        states = self.messages(self.live, '/aligner/state')
        self.assertEqual([state.tau for state in states[:3]], [0.0, 0.01, 0.02], 'the start is there')
        self.assertEqual(states[-1].tau, 3.0)
        self.assertEqual(len(states), 301)
        self.assertEqual(self.messages(self.live, '/aligner/result')[0].outcome, 'time_limit')

    def test_both_hold_the_same_trial(self):
        live, offline = (self.messages(path, '/aligner/state') for path in (self.live, self.offline))
        self.assertEqual(len(live), len(offline))
        for a, b in zip(live, offline):
            self.assertEqual((a.tau, a.dimensionless, a.si, a.impacts), (b.tau, b.dimensionless, b.si, b.impacts))
        for topic in ('reaction/a1', 'reaction/a2'):
            live, offline = (self.messages(path, '/aligner/' + topic) for path in (self.live, self.offline))
            self.assertEqual([message.wrench for message in live], [message.wrench for message in offline])

    def test_offline_bag_is_in_simulated_time(self):
        for state in self.messages(self.offline, '/aligner/state'):
            self.assertAlmostEqual(state.header.stamp.to_sec(), 1.0 + state.time, places=8)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'record', Record)
