#!/usr/bin/env python3
"""What may happen to a node among others. roslaunch starts it again whenever it ends."""
import os
import signal
import subprocess
import tempfile
import time
from xmlrpc.client import ServerProxy

import actionlib
import rosgraph
import rospy
import rostest
import tf2_ros
from actionlib_msgs.msg import GoalStatus
from dynamic_reconfigure.client import Client

from aligner_test_case import AlignerTestCase, program, scene_path
from vibratory_alignment.msg import AlignAction, AlignGoal, AlignResult, AlignerState
from vibratory_alignment.srv import LoadScene


class Faults(AlignerTestCase):

    def process_id(self):
        """Of the aligner that runs now, None while none does."""
        try:
            return ServerProxy(rosgraph.Master('/test_faults').lookupNode('/aligner')).getPid('/test_faults')[2]
        except (OSError, rosgraph.MasterException):
            return None

    def spawn(self, *command):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL,
                                   preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))  # ignored under nohup
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_killed_and_respawned(self):
        buffer = tf2_ros.Buffer(rospy.Duration(60.0))
        tf2_ros.TransformListener(buffer)
        states = self.listen('state')
        client = actionlib.SimpleActionClient('/aligner/align', AlignAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(15.0)))
        client.send_goal(AlignGoal())
        self.assertTrue(states.wait_for(50))
        self.kill_and_await_the_next()
        deadline = time.time() + 15.0
        while client.get_state() != GoalStatus.LOST:
            self.assertLess(time.time(), deadline, 'the client waits for ever for a result')
            time.sleep(0.1)
        self.reset(states)  # the services are those of the new one
        time.sleep(0.2)
        found = buffer.lookup_transform('world', 'part', rospy.Time(0))
        last = states.messages[-1]
        self.assertGreater(found.header.stamp, last.header.stamp - rospy.Duration(0, 1000), 'not the pose of before')
        self.assertEqual(found.transform.translation.x, last.si.x)
        self.assertTrue(buffer.can_transform('world', 'edge_a2', rospy.Time(0)))
        self.assertEqual(self.run_to_end(states).tau, 3.0)
        self.assertEqual(len(states.messages), 301)

    def kill_and_await_the_next(self):
        old = self.process_id()
        os.kill(old, signal.SIGKILL)
        deadline = time.time() + 15.0
        while self.process_id() in (old, None):
            self.assertLess(time.time(), deadline, 'it does not come back')
            time.sleep(0.1)

    def test_respawned_has_the_time_scale_of_the_first_start(self):
        Client('/aligner', timeout=15.0).update_configuration({'time_scale': 0.5})
        time.sleep(0.5)
        self.kill_and_await_the_next()
        self.call('reset')
        self.assertEqual(Client('/aligner', timeout=15.0).get_configuration(timeout=5.0)['time_scale'], 0.01)

    def test_time_scale_that_was_not_given_is_no_parameter_later(self):
        self.start_own(time_scale=None)
        client = Client('/own', timeout=15.0)
        for scale in (0.5, 0.25):
            self.assertFalse(self.becomes_parameter('/own/time_scale'), scale)
            client.update_configuration({'time_scale': scale})
        self.assertEqual(rospy.get_param('/own/amplitude'), 1.0, 'the others are kept there as usual')

    def becomes_parameter(self, name):
        """False as soon as it is none, within a second."""
        deadline = time.time() + 1.0
        while rospy.has_param(name) and time.time() < deadline:
            time.sleep(0.05)
        return rospy.has_param(name)

    def start_own(self, time_scale=0.01, autostart='false', wait_for=None, scene='small', sample_interval=0.001):
        """An aligner that roslaunch knows nothing of."""
        if rospy.has_param('/own'):
            rospy.delete_param('/own')
        optional = dict(time_scale=time_scale, sample_interval=sample_interval, wait_for_subscribers=wait_for)
        others = ['_%s:=%s' % (name, value) for name, value in optional.items() if value is not None]
        process = self.spawn(program('aligner_node'), '__name:=own', '_scene_file:=' + scene_path(scene),
                             '_autostart:=' + autostart, *others)
        self.node = '/own'
        rospy.wait_for_service('/own/step', 15.0)
        return process

    def test_reset_before_the_subscribers_are_there_waits_for_start_all_the_same(self):
        for request in (lambda: self.call('reset'), lambda: rospy.ServiceProxy('/own/load_scene', LoadScene)(
                scene_path('small'))):
            process = self.start_own(autostart='true', wait_for='result')
            self.assertIn('paused at the start', request().message)
            states = self.listen('state')
            self.listen('result')
            self.assertTrue(states.wait_for(1))
            time.sleep(0.5)
            self.assertEqual([state.tau for state in states.messages], [0.0])
            self.assertTrue(self.call('start').success)
            self.assertTrue(states.wait_for(20))
            self.assert_ends_at_once(process, process.terminate)

    def test_settings_without_a_start_are_told_by_every_service(self):
        self.start_own(wait_for='result')
        states = self.listen('state')
        client = Client('/own', timeout=15.0)
        client.update_configuration({'pressing_force': 0.0})
        self.assertIn('as soon as', self.call('start').message)
        self.assertIn('not started', self.call('step').message)
        self.listen('result')
        time.sleep(1.0)
        for response in (self.call('start'), self.call('step'), self.step_by(samples=3)):
            self.assertFalse(response.success)
            self.assertIn('cannot start', response.message)
        self.assertEqual(states.messages, [])
        client.update_configuration({'pressing_force': 0.2})
        self.assertEqual(self.step_by(samples=3).samples, 3)
        self.assertTrue(states.wait_for(4))
        self.assertTrue(self.call('start').success)
        self.assertTrue(states.wait_for(20))

    def test_scenes_after_one_with_other_scales_keep_its_rate(self):
        self.start_own(time_scale=None, sample_interval=None)
        states = self.listen('state')
        load = rospy.ServiceProxy('/own/load_scene', LoadScene)
        with open(scene_path('small')) as small:
            text = small.read()
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
            file.write(''.join(line + '\n' for line in text.splitlines() if not line.startswith('scales')))
            file.flush()
            for scenes in ([scene_path('small')] * 2, [file.name] * 2, [scene_path('small')] * 2):
                intervals = []
                for scene in scenes:
                    states.forget(0)
                    self.assertTrue(load(scene).success)
                    response = self.step_by(samples=1)
                    self.assertEqual(response.samples, 1, response.message)
                    self.assertTrue(states.wait_for(2))
                    intervals.append(states.messages[-1].tau)
                self.assertEqual(intervals[0], intervals[1])

    def assert_ends_at_once(self, process, end):
        start = time.time()
        end()
        self.assertEqual(process.wait(5.0), 0)
        self.assertLess(time.time() - start, 1.0)

    def test_node_that_loses_its_name_says_so(self):
        arguments = (program('aligner_node'), '__name:=own', '_scene_file:=' + scene_path('small'), '_autostart:=false')
        first = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.addCleanup(first.kill)
        rospy.wait_for_service('/own/step', 15.0)
        second = self.spawn(*arguments)
        output, _ = first.communicate(timeout=10.0)
        self.assertEqual(first.returncode, 0)
        self.assertIn('new node registered with same name', output)
        time.sleep(1.0)
        self.assertIsNone(second.poll(), 'what the first one does at its end ends the second one')
        self.node = '/own'
        self.assertTrue(self.call('step').success)

    def test_subscriber_that_never_reads(self):
        process = self.start_own()
        stuck = self.spawn('rostopic', 'echo', '/own/state')
        states = self.listen('/own/state', AlignerState)
        time.sleep(1.5)
        self.reset(states)
        os.kill(stuck.pid, signal.SIGSTOP)
        for _ in range(2):  # more messages of half a kB than a queue or the connection holds
            result = self.run_to_end(states)
            self.assertEqual(result.tau, 3.0)
            self.assertEqual(len(states.messages), 3001, 'who reads gets all of them')
        self.assert_ends_at_once(process, process.terminate)

    def test_stopped_in_the_middle_of_a_goal(self):
        def kill_node():
            """As `rosnode kill`."""
            uri = rosgraph.Master('/test_faults').lookupNode('/own')
            self.assertEqual(ServerProxy(uri).shutdown('/test_faults', 'not wanted')[0], 1)

        for end in (lambda: process.send_signal(signal.SIGINT), lambda: process.send_signal(signal.SIGTERM),
                    lambda: process.send_signal(signal.SIGHUP), kill_node):
            process = self.start_own()
            states = self.listen('/own/state', AlignerState)
            client = actionlib.SimpleActionClient('/own/align', AlignAction)
            self.assertTrue(client.wait_for_server(rospy.Duration(15.0)))
            client.send_goal(AlignGoal())
            self.assertTrue(states.wait_for(300))
            self.assert_ends_at_once(process, end)
            deadline = time.time() + 2.0
            while client.get_result() is None and time.time() < deadline:
                time.sleep(0.01)
            self.assertEqual(client.get_state(), GoalStatus.ABORTED)
            self.assertEqual(client.get_goal_status_text(), 'the node ends')
            self.assertNotEqual(client.get_result(), AlignResult())
            self.assertTrue(states.wait(lambda messages: messages[-1].tau == client.get_result().tau, 2.0),
                            'the last sample is lost')


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'faults', Faults)
