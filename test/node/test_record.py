#!/usr/bin/env python3
"""A bag from a live trial and one from `align trial --bag`."""
import filecmp
import itertools
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import rospy
import rostest

from aligner_test_case import align, program, scene_path
from bag_reader import difference, picture, plain, read, types

TOPICS = ['contacts', 'markers', 'parameter_updates', 'reaction/a1', 'reaction/a2', 'restarts', 'result', 'state']


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

    def test_both_hold_the_topics_of_the_node(self):
        self.assertEqual(types(self.live), types(self.offline))
        self.assertEqual(set(types(self.live)), {'/aligner/' + topic for topic in TOPICS} | {'/tf', '/tf_static'})

    def test_is_whole_in_a_namespace_too(self):
        bag = os.path.join(self.directory.name, 'cell.bag')
        arguments = dict(scene=scene_path('small'), rviz='false', record=bag, sample_interval='0.01', time_scale='0.01',
                         exit_when_done='true')
        launch = ('<launch><group ns="cell"><include file="$(find vibratory_alignment)/launch/trial.launch">%s'
                  '</include></group></launch>' % ''.join('<arg name="%s" value="%s"/>' % item
                                                          for item in arguments.items()))
        subprocess.run(['roslaunch', '-'], input=launch, universal_newlines=True, check=True)
        self.assertEqual(set(types(bag)), {'/cell/aligner/' + topic for topic in TOPICS} | {'/tf', '/tf_static'})
        self.assertEqual([len(read(bag, '/cell/aligner/' + topic)) for topic in ('state', 'result')], [301, 1])

    def test_is_refused_where_ros_time_stands_still(self):
        bag = os.path.join(self.directory.name, 'none.bag')
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        run = subprocess.run(['roslaunch', 'vibratory_alignment', 'record.launch', 'bag:=' + bag],
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=40.0)
        self.assertIn('rosparam delete /use_sim_time', run.stdout)
        self.assertIn('exit code 1', run.stdout)

    def test_trial_ends_at_once_with_a_recorder_that_cannot_start(self):
        bag = os.path.join(self.directory.name, 'none', 'trial.bag')
        start = time.time()
        run = subprocess.run(['roslaunch', 'vibratory_alignment', 'trial.launch', 'scene:=' + scene_path('small'),
                              'rviz:=false', 'record:=' + bag, 'least_free:=1M'], stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, universal_newlines=True, timeout=60.0)
        self.assertLess(time.time() - start, 25.0, 'the node waits 30 s for the recorder')
        self.assertIn('REQUIRED process [record_aligner', run.stdout)

    def test_words_that_rosbag_would_take_for_something_else_are_refused(self):
        for word, why in (('bad topic', 'no name of a topic'), ('--min-space=abc', 'least_free: abc')):
            run = subprocess.run([program('record_bag'), os.path.join(self.directory.name, 'none.bag'), word],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=40.0)
            self.assertEqual(run.returncode, 1)
            self.assertIn(why, run.stderr)

    def refusal(self, bag, *words):
        run = subprocess.run([program('record_bag'), bag, '/tf', *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             universal_newlines=True, timeout=40.0)
        self.assertEqual(run.returncode, 1)
        return run.stderr

    def test_nothing_is_begun_where_a_bag_would_be_lost_or_get_no_name(self):
        folder = os.path.join(self.directory.name, 'kept')
        os.makedirs(os.path.join(folder, 'folder.bag'))
        bag, killed = os.path.join(folder, 'whole.bag'), os.path.join(folder, 'killed.bag')
        for path in (bag, killed + '.active'):
            shutil.copy(self.live, path)
        self.assertIn('folder.bag: is a directory', self.refusal(os.path.join(folder, 'folder.bag')))
        self.assertIn('is a directory', self.refusal(folder + '/'))
        self.assertIn('rosbag reindex', self.refusal(killed))
        self.assertIn('less than 999999G is free on the disk', self.refusal(bag, '--min-space=999999G'))
        for path in (bag, killed + '.active'):
            self.assertTrue(filecmp.cmp(path, self.live, shallow=False), path)
        self.assertEqual(sorted(os.listdir(folder)), ['folder.bag', 'killed.bag.active', 'whole.bag'])

    def test_signal_to_the_recorder_alone_ends_it_with_a_whole_bag(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            bag = os.path.join(self.directory.name, '%s.bag' % number.name)
            recorder = subprocess.Popen([program('record_bag'), bag, '/rosout'], stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, start_new_session=True,
                                        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))  # nohup
            deadline = time.time() + 20.0
            while not os.path.exists(bag + '.active') and time.time() < deadline:
                time.sleep(0.05)
            recorder.send_signal(number)
            recorder.communicate(timeout=20.0)
            self.assertEqual((recorder.returncode, os.path.exists(bag)), (0, True), number.name)

    def test_name_of_a_bag_may_have_any_sign(self):
        name = 'it\'s a "b\u00fcg" $1.bag'
        for launch, node in (('record.launch', 'record_aligner'), ('replay.launch', 'play')):
            command = subprocess.check_output(['roslaunch', '--args', node, 'vibratory_alignment', launch, 'bag:=' + name],
                                              universal_newlines=True)
            self.assertIn(name, command)

    def test_action_is_recorded_on_request(self):
        for request, expected in (('false', set()), ('true', {'goal', 'cancel', 'feedback', 'result', 'status'})):
            command = subprocess.check_output(['roslaunch', '--args', 'record_aligner', 'vibratory_alignment',
                                               'record.launch', 'bag:=x.bag', 'action:=' + request],
                                              universal_newlines=True)
            self.assertEqual(set(re.findall(r' aligner/align/(\w+)', command)), expected)
            self.assertIn(' aligner/restarts', command)

    def test_a_scene_file_may_end_in_yml(self):
        path = os.path.join(self.directory.name, 'small.yml')
        shutil.copy(scene_path('small'), path)
        parameters = subprocess.check_output(['roslaunch', '--dump-params', 'vibratory_alignment', 'trial.launch',
                                              'rviz:=false', 'scene:=' + path], universal_newlines=True)
        self.assertIn('/aligner/scene/name: small\n', parameters)

    def test_live_bag_is_whole(self):
        self.assertEqual(os.path.exists(self.live + '.active'), False)
        states = read(self.live, '/aligner/state')
        self.assertEqual([state.tau for state in states[:3]], [0.0, 0.01, 0.02], 'the start is there')
        self.assertEqual(states[-1].tau, 3.0)
        self.assertEqual(len(states), 301)
        self.assertEqual(read(self.live, '/aligner/result')[0].outcome, 'time_limit')

    def test_both_hold_the_same_trial(self):
        live, offline = (read(path, '/aligner/state') for path in (self.live, self.offline))
        for a, b in zip(live, offline):
            self.assertEqual((a.tau, a.dimensionless, a.si, a.impacts), (b.tau, b.dimensionless, b.si, b.impacts))
        # Impulses are summed up over other intervals, so that their last digits differ.
        for topic in ('/aligner/state', '/aligner/contacts', '/aligner/reaction/a1', '/aligner/reaction/a2',
                      '/aligner/restarts', '/aligner/result', '/tf', '/tf_static'):
            live, offline = (plain(read(path, topic)) for path in (self.live, self.offline))
            if topic == '/tf':  # a live node goes on to tell where the part is at the end
                live, offline = ([pose for pose, _ in itertools.groupby(side)] for side in (live, offline))
            self.assertIsNone(difference(live, offline, 1e-9, topic))

    def test_both_tell_the_same_settings(self):
        def settings(path):
            config = read(path, '/aligner/parameter_updates')[0]
            return {entry.name: entry.value for entry in config.bools + config.ints + config.doubles}
        live, offline = settings(self.live), settings(self.offline)
        self.assertEqual((live.pop('time_scale'), offline.pop('time_scale')), (0.01, 1.0))
        self.assertEqual(live, offline)

    def test_both_end_in_the_same_picture(self):
        live, offline = (picture(read(path, '/aligner/markers')) for path in (self.live, self.offline))
        self.assertGreater(len(live), 4)
        self.assertEqual(set(live), set(offline))
        for name in live:
            self.assertIsNone(difference(live[name], offline[name], 1e-9, str(name)))

    def test_offline_bag_is_in_simulated_time(self):
        for state in read(self.offline, '/aligner/state'):
            self.assertAlmostEqual(state.header.stamp.to_sec(), 1.0 + state.time, places=8)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'record', Record)
