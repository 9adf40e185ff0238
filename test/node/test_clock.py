#!/usr/bin/env python3
"""The node publishes simulated time as /clock, and what others make of it."""
import os
import signal
import subprocess
import time
from xmlrpc.client import ServerProxy

import actionlib
import rosgraph
import rospy
import rostest
import tf2_ros
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

from aligner_test_case import AlignerTestCase, Listener, Newcomer, program, scene_path
from vibratory_alignment.msg import AlignAction, AlignGoal

START = rospy.Time(1)  # where the clock begins
INTERVAL = 0.01 * 5e-3  # between two samples [s]


class OwnClock(AlignerTestCase):

    def setUp(self):
        self.clock = Listener('/clock', Clock)
        self.states = self.listen('state')
        self.reset(self.states)

    def instants(self):
        return [message.clock for message in self.clock.messages]

    def assert_never_zero_nor_back(self, instants):
        self.assertGreaterEqual(instants[0], START)
        for earlier, later in zip(instants, instants[1:]):
            self.assertLessEqual(earlier, later)

    def test_stands_at_the_start_until_the_trial_starts(self):
        late = Listener('/clock', Clock)
        self.assertTrue(late.wait_for(3, 5.0), 'who comes late gets the time all the same')
        self.assertLess(late.messages[-1].clock, START + rospy.Duration(1e-6))

    def test_runs_with_the_trial(self):
        self.clock.forget(0)
        self.call('start')
        self.assertTrue(self.states.wait(lambda states: states[-1].tau == 3.0))
        self.clock.wait(lambda messages: messages[-1].clock == self.states.messages[-1].header.stamp)
        self.assert_never_zero_nor_back(self.instants())
        for state in self.states.messages:
            self.assertAlmostEqual((state.header.stamp - START).to_sec(), state.time, delta=1e-7)
        stamps = [state.header.stamp for state in self.states.messages]
        self.assertEqual(len(set(stamps)), len(stamps))
        told = set(self.instants())
        self.assertLessEqual(told, set(stamps), 'the clock is where a sample is')
        self.assertGreater(len(told), 0.9 * len(stamps))  # rospy keeps but the newest for its own use

    def test_step_by_moves_it_by_the_samples(self):
        before = self.states.messages[-1].header.stamp
        self.assertTrue(self.step_by(samples=40).success)
        self.assertTrue(self.clock.wait(lambda messages: messages[-1].clock > before + rospy.Duration(39.5 * INTERVAL)))
        time.sleep(0.3)
        self.assertAlmostEqual((self.clock.messages[-1].clock - before).to_sec(), 40 * INTERVAL, delta=1e-7)

    def test_who_joins_tf_while_it_stands_finds_the_part(self):
        self.clock.forget(1)
        self.step_by(samples=5)
        self.assertTrue(self.states.wait_for(6))
        last = self.states.messages[-1]
        stamps = [last.header.stamp]
        for _ in range(2):
            newcomer = Newcomer('/tf', TFMessage)
            self.addCleanup(newcomer.close)
            part = newcomer.next().transforms[0]
            self.assertEqual((part.child_frame_id, part.transform.translation.x), ('part', last.si.x))
            stamps.append(part.header.stamp)
        self.assertIsNone(newcomer.next(1.2), 'time stands: there is nothing to add')
        self.assertEqual(len(set(stamps)), 3, 'a stamp was published twice')
        self.assert_never_zero_nor_back(self.instants())
        self.assertLess(self.instants()[-1] - last.header.stamp, rospy.Duration(0, 10), 'it stands')

    def test_reset_is_announced_and_a_tf_buffer_survives_it(self):
        restarts = self.listen('restarts')
        buffer = tf2_ros.Buffer(rospy.Duration(10.0))
        tf2_ros.TransformListener(buffer)
        moving = self.listen('/tf', TFMessage)
        self.call('start')
        self.assertTrue(self.states.wait(lambda states: states[-1].tau == 3.0))
        self.assertTrue(moving.wait(lambda messages: messages[-1].transforms[0].header.stamp ==
                                    self.states.messages[-1].header.stamp))
        time.sleep(0.2)
        end = buffer.lookup_transform('world', 'part', rospy.Time(0)).transform.translation
        count = len(restarts.messages)
        self.states.forget(0)
        self.assertTrue(self.call('reset').success)
        self.assertTrue(restarts.wait_for(count + 1))
        self.assertTrue(self.states.wait_for(1))
        time.sleep(0.2)
        self.assertLess(self.clock.messages[-1].clock, START + rospy.Duration(1e-6), 'it goes back')
        start = self.states.messages[0].si
        self.assertNotEqual(end.x, start.x)
        found = buffer.lookup_transform('world', 'part', rospy.Time(0))
        self.assertEqual((found.transform.translation.x, found.transform.translation.z), (start.x, start.y),
                         'the pose of the start, not that of before the reset')
        self.assertTrue(buffer.can_transform('world', 'edge_a1', rospy.Time(0)), 'what is static stays')
        self.step_by(samples=10)
        self.assertTrue(self.states.wait_for(11))
        time.sleep(0.2)
        found = buffer.lookup_transform('world', 'part', rospy.Time(0))
        self.assertEqual(found.header.stamp, self.states.messages[-1].header.stamp)

    def test_a_cell_that_is_started_again_at_the_same_instant_is_heard(self):
        # its goals would have the same ids, by which the action tells them apart
        rospy.set_param('/again', {'parts': [{'part': 'one', 'scene': scene_path('small')}], 'patience': 8.0})
        for _ in range(2):
            self.reset(self.states)
            cell = subprocess.run([program('cell.py'), '__name:=again'], stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, universal_newlines=True, timeout=30.0)
            self.assertIn('one: time_limit after', cell.stdout)

    def test_goals_never_set_it_back(self):
        client = actionlib.SimpleActionClient('/aligner/align', AlignAction)
        self.assertTrue(client.action_client.wait_for_server(rospy.Duration(0)) or client.wait_for_server())
        self.step_by(samples=50)
        self.clock.forget(1)
        for limit, end in ((0.3, 0.3), (0.0, 3.0)):
            client.send_goal(AlignGoal(scene=scene_path('small'), time_limit=limit))
            deadline = time.time() + 10.0
            while client.get_result() is None and time.time() < deadline:
                time.sleep(0.01)
            self.assertEqual(client.get_result().tau, end)
        time.sleep(0.2)
        self.assert_never_zero_nor_back(self.instants())
        self.assertGreater(self.instants()[-1] - self.instants()[0], rospy.Duration(3.3 * 5e-3 - 1e-6))

    def start_second(self):
        process = subprocess.Popen((program('aligner_node'), '__name:=second', '_scene_file:=' + scene_path('small'),
                                    '_publish_clock:=true', '_autostart:=false'), stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, universal_newlines=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def test_second_clock_is_refused(self):
        process = self.start_second()
        output, _ = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 1)
        self.assertIn('/second/publish_clock: true: /aligner publishes /clock already', output)

    def test_zz_clock_of_a_killed_node_is_in_nobodys_way(self):
        """The last one: it kills the aligner."""
        uri = rosgraph.Master('/test_clock').lookupNode('/aligner')
        os.kill(ServerProxy(uri).getPid('/test_clock')[2], signal.SIGKILL)
        process = self.start_second()
        rospy.wait_for_service('/second/step', 15.0)
        self.assertIsNone(process.poll())


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'clock', OwnClock)
