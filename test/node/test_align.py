#!/usr/bin/env python3
"""The action ~align."""
import json
import math
import os
import tempfile
import time

import actionlib
import dynamic_reconfigure.client
import rospy
import rospkg
import rostest
import yaml
from actionlib_msgs.msg import GoalID, GoalStatus
from std_srvs.srv import Trigger

from aligner_test_case import AlignerTestCase, align, scene_path
from vibratory_alignment.msg import AlignAction, AlignGoal, AlignResult
from vibratory_alignment.srv import LoadScene

TIME_UNIT, FORCE_UNIT = 5e-3, 8.0  # of small.yaml [s], [N]
PACKAGE = rospkg.RosPack().get_path('vibratory_alignment')
DONE = (GoalStatus.REJECTED, GoalStatus.PREEMPTED, GoalStatus.ABORTED, GoalStatus.SUCCEEDED, GoalStatus.RECALLED)


class Client(actionlib.SimpleActionClient):
    """Waits in wall time, and keeps the feedback."""

    def __init__(self):
        super().__init__('/aligner/align', AlignAction)
        self.feedback, self.arrivals = [], []

    def _keep(self, feedback):
        self.feedback.append(feedback)
        self.arrivals.append(time.time())

    def send(self, **fields):
        self.feedback, self.arrivals = [], []
        self.send_goal(AlignGoal(**fields), feedback_cb=self._keep)

    def wait_until(self, condition, timeout=20.0):
        deadline = time.time() + timeout
        while not condition() and time.time() < deadline:
            time.sleep(0.005)
        return condition()

    def done(self, timeout=20.0):
        """State and result."""
        assert self.wait_until(lambda: self.get_state() in DONE and self.get_result() is not None, timeout), \
            'the goal does not end'
        return self.get_state(), self.get_result()

    def running(self):
        return self.wait_until(lambda: len(self.feedback) >= 2)


class Align(AlignerTestCase):

    def setUp(self):
        self.settings = dynamic_reconfigure.client.Client('/aligner', timeout=15.0)
        self.client = Client()
        self.assertTrue(self.client.wait_for_server(rospy.Duration(15.0)))
        self.time_scale(0.01)
        self.states = self.listen('state')

    def tearDown(self):
        self.client.cancel_all_goals()
        self.client.wait_until(lambda: self.client.get_state() in DONE, 2.0)

    def time_scale(self, scale):
        self.settings.update_configuration({'time_scale': scale})

    def expected(self, scene, *settings):
        options = [word for setting in settings for word in ('--set', setting)]
        return json.loads(align('trial', scene, '--json', *options))

    def assert_rejected(self, *parts, **fields):
        self.client.send(**fields)
        state, result = self.client.done()
        self.assertEqual(state, GoalStatus.REJECTED)
        for part in parts:
            self.assertIn(part, self.client.get_goal_status_text())
        self.assertEqual(result, AlignResult(), 'nothing ran')

    # --- goal, feedback, result ---------------------------------------------------------------------------------------

    def test_result_and_samples_are_those_of_the_command_line(self):
        self.time_scale(0.0)
        self.client.send(scene='fig2', set_pressing_force=True, pressing_force=0.3, set_excitation=True, amplitude=1.1,
                         frequency=25.0, phase=0.5, waveform=AlignGoal.TRIANGLE, force_limit=1.0)
        state, result = self.client.done()
        expected = self.expected('fig2', 'gripper.pressing_force=0.3', 'excitation.amplitude=1.1',
                                 'excitation.frequency=25', 'excitation.phase=0.5', 'excitation.waveform=triangle')
        aligned = expected['outcome'] == 'aligned'
        self.assertEqual(state, GoalStatus.SUCCEEDED if aligned else GoalStatus.ABORTED)
        self.assertEqual((result.outcome, result.mode, result.tau),
                         (expected['outcome'], expected['mode'], expected['final']['t']))
        self.assertEqual(list(result.impacts), [expected['impacts'][spot] for spot in ('a1', 'a2', 'b1', 'b2')])
        for peak, spot in zip(result.peak_force, ('a1', 'a2', 'b1', 'b2')):
            self.assertAlmostEqual(peak, expected['peak_force'][spot] * FORCE_UNIT, places=9)
        self.assertTrue(result.force_limit_exceeded)
        if aligned:
            self.assertEqual(result.duration_tau, expected['duration'])
            self.assertAlmostEqual(result.duration, expected['duration'] * TIME_UNIT, places=12)
        self.assertLess(result.energy_residual, 1e-6)
        self.assertIn(result.outcome, result.text)
        self.assertEqual(self.settings.get_configuration()['pressing_force'], 0.3, 'the settings follow')
        self.assertEqual(self.states.messages[-1].scene, 'fig2')

    def test_time_limit_is_kept_and_not_aligned_is_aborted(self):
        self.client.send(scene=scene_path('small'), time_limit=1.005)
        state, result = self.client.done()
        self.assertEqual((state, result.outcome, result.tau), (GoalStatus.ABORTED, 'time_limit', 1.005))
        self.assertTrue(math.isnan(result.duration) and math.isnan(result.duration_tau))
        self.assertFalse(result.force_limit_exceeded)
        self.client.send()
        self.assertEqual(self.client.done()[1].tau, 3.0, 'a goal without limits has those of the scene')

    def test_feedback_comes_at_its_rate_and_misses_no_force(self):
        self.client.send(scene=scene_path('small'))  # 1.5 s of wall time
        _, result = self.client.done()
        feedback, arrivals = self.client.feedback, self.client.arrivals
        self.assertAlmostEqual(len(feedback), 16, delta=4)
        self.assertAlmostEqual((arrivals[-2] - arrivals[1]) / (len(arrivals) - 3), 0.1, delta=0.02)
        self.assertTrue(self.states.wait(lambda states: states[-1].tau >= feedback[-1].tau))
        instants = [message.tau for message in feedback]
        self.assertEqual(instants, sorted(instants))
        before = -1.0
        for message in feedback:
            states = [state for state in self.states.messages if before < state.tau <= message.tau]
            before = message.tau
            for spot in range(4):
                self.assertEqual(message.peak_force[spot], max(state.peak_force[spot] for state in states))
        self.assertGreater(result.peak_force[0], 0.0)
        by_instant = {state.tau: state for state in self.states.messages}
        for message in feedback:
            state = by_instant[message.tau]
            self.assertEqual((message.progress, message.misalignment, message.mode, message.time),
                             (state.progress, state.misalignment, state.mode, state.time))

    def test_cancel_ends_it_with_the_result_so_far(self):
        self.client.send(scene=scene_path('small'))
        self.assertTrue(self.client.running())
        self.client.cancel_goal()
        state, result = self.client.done()
        self.assertEqual((state, result.outcome), (GoalStatus.PREEMPTED, 'running'))
        time.sleep(0.3)
        last = self.states.messages[-1]
        self.assertEqual(result.tau, last.tau, 'paused where it was')
        self.assertEqual(result.impacts, last.impacts)
        self.assertTrue(self.call('start').success, 'it can be run to its end all the same')

    def test_stamps_at_the_end_of_ros_time_end_nothing(self):
        # actionlib keeps what it knows of these until their stamps and five seconds more, which are no time any more
        last = rospy.Time(4294967295)
        cancels = rospy.Publisher('/aligner/align/cancel', GoalID, queue_size=10)
        wait_for = time.time() + 15.0
        while cancels.get_num_connections() == 0 and time.time() < wait_for:
            time.sleep(0.05)
        cancels.publish(GoalID(stamp=last, id='of nobody'))
        time.sleep(1.0)  # its status is published by then
        self.client.send(scene=scene_path('small'))
        self.assertEqual(self.client.done()[1].tau, 3.0)

    # --- refusals -----------------------------------------------------------------------------------------------------

    def test_one_goal_at_a_time(self):
        self.client.send(scene=scene_path('small'))
        self.assertTrue(self.client.running())
        other = Client()
        other.wait_for_server(rospy.Duration(15.0))
        other.send(scene='fig2')
        self.assertEqual(other.done()[0], GoalStatus.REJECTED)
        self.assertIn('another goal', other.get_goal_status_text())
        self.assertEqual(self.client.done()[1].tau, 3.0, 'the first is not disturbed')

    def test_numbers_that_cannot_be_are_rejected_with_field_value_and_range(self):
        nan, inf = float('nan'), float('inf')
        good = dict(set_excitation=True, amplitude=1.0, frequency=20.0)
        for field, values, allowed in (('amplitude', (nan, inf, -1.0, 1001.0), 'from 0 to 1000'),
                                       ('frequency', (nan, inf, 0.0, 1e9), 'from 0.001 to 10000'),
                                       ('phase', (nan, -inf, 7.0), 'from -6.28'),
                                       ('waveform', (4, 255), '0 sine'),
                                       ('time_limit', (nan, inf, -1.0), '> 0'),
                                       ('force_limit', (nan, inf, -1.0), '> 0')):
            for value in values:
                self.assert_rejected(field + ': %g: ' % value, allowed, **dict(good, **{field: value}))
        for value in (nan, inf, -1.0):
            self.assert_rejected('pressing_force: ', '0 to 1000', set_pressing_force=True, pressing_force=value)

    def test_all_faults_are_told_at_once(self):
        self.assert_rejected('amplitude', 'time_limit', 'no_such_scene', scene='no_such_scene', time_limit=-1.0,
                             set_excitation=True, amplitude=-1.0, frequency=20.0)

    def test_values_without_their_flag_are_rejected(self):
        self.assert_rejected('amplitude: 2', 'set_excitation', amplitude=2.0)
        self.assert_rejected('phase: nan', 'set_excitation', phase=float('nan'))
        self.assert_rejected('waveform: 1', 'set_excitation', waveform=1)
        self.assert_rejected('pressing_force', 'set_pressing_force', pressing_force=0.2)

    def test_scenes_that_cannot_be_run_are_rejected(self):
        self.assert_rejected('scene: fig22: no such file', 'fig2', scene='fig22')
        self.assert_rejected('is a directory', scene='/')
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
            file.write(open(scene_path('small')).read().replace('clearance', 'clearence'))
            file.flush()
            self.assert_rejected(file.name, 'slot.clearence', scene=file.name)
        self.assert_rejected('chirp', set_excitation=True, amplitude=1.0, frequency=20.0, waveform=AlignGoal.CHIRP)

    def test_rejection_leaves_the_running_trial_alone(self):
        self.reset(self.states)
        self.call('start')
        self.assertTrue(self.states.wait_for(20))
        before = self.settings.get_configuration()
        self.assert_rejected('frequency', set_excitation=True, amplitude=1.0, frequency=float('nan'))
        count = len(self.states.messages)
        self.assertTrue(self.states.wait_for(count + 20))
        for i, state in enumerate(self.states.messages):
            self.assertEqual(state.tau, i * 0.01)
        self.assertEqual(self.settings.get_configuration(), before)

    # --- with services and settings -----------------------------------------------------------------------------------

    def test_goal_takes_over_from_a_trial_that_runs(self):
        self.reset(self.states)
        self.call('start')
        self.assertTrue(self.states.wait_for(20))
        self.client.send(scene=scene_path('small'), time_limit=0.5)
        self.assertEqual(self.client.done()[1].tau, 0.5)

    def test_pause_start_and_step_hold_and_go_on(self):
        self.client.send(scene=scene_path('small'))
        self.assertTrue(self.client.running())
        self.assertTrue(self.call('pause').success)
        self.assertTrue(self.client.wait_until(lambda: self.client.feedback[-1].paused))
        count = len(self.client.feedback)
        self.assertTrue(self.client.wait_until(lambda: len(self.client.feedback) > count + 3), 'feedback goes on')
        tau = self.client.feedback[-1].tau
        self.assertEqual(self.client.feedback[-3].tau, tau)
        self.assertTrue(self.call('step').success)
        self.assertTrue(self.client.wait_until(lambda: self.client.feedback[-1].tau > tau))
        self.assertAlmostEqual(self.client.feedback[-1].tau, tau + 0.01, places=9)
        self.assertEqual(self.client.get_state(), GoalStatus.ACTIVE)
        self.assertTrue(self.call('start').success)
        self.assertEqual(self.client.done()[1].tau, 3.0)

    def test_step_right_after_the_goal_is_taken(self):
        step = rospy.ServiceProxy('/aligner/step', Trigger, persistent=True)  # or it would arrive later
        for _ in range(30):
            self.call('reset')
            self.client.send()
            response = step()
            self.assertTrue(response.success, response.message)

    def test_reset_ends_the_goal(self):
        self.client.send(scene=scene_path('small'), time_limit=2.0)
        self.assertTrue(self.client.running())
        reached = self.client.feedback[-1].tau
        self.assertTrue(self.call('reset').success)
        state, result = self.client.done()
        self.assertEqual((state, result.outcome), (GoalStatus.ABORTED, 'running'))
        self.assertGreaterEqual(result.tau, reached)
        self.assertIn('reset', self.client.get_goal_status_text())
        time.sleep(0.3)
        self.assertEqual(self.states.messages[-1].tau, 0.0)
        self.assertTrue(self.call('start').success)
        self.assertTrue(self.states.wait(lambda states: states[-1].tau == 2.0))
        time.sleep(0.3)
        self.assertEqual(self.states.messages[-1].tau, 2.0, 'the trial is still that of the goal')
        self.assertEqual(self.run_to_end(self.states).tau, 3.0, 'no goal was active when it was reset once more')

    def test_limits_of_a_goal_end_with_its_trial(self):
        self.time_scale(0.0)
        self.client.send(scene=scene_path('small'), time_limit=1.0, force_limit=1e-3)
        _, result = self.client.done()
        self.assertEqual((result.tau, result.force_limit_exceeded), (1.0, True))
        again = self.run_to_end(self.states)
        self.assertEqual((again.tau, again.force_limit_exceeded), (3.0, False), 'the scene has no limit of the force')

    def load_scene(self, scene):
        return rospy.ServiceProxy('/aligner/load_scene', LoadScene)(scene)

    def test_another_scene_ends_the_goal_and_one_that_is_refused_does_not(self):
        self.client.send(scene=scene_path('small'))
        self.assertTrue(self.client.running())
        response = self.load_scene('no_such_scene')
        self.assertFalse(response.success)
        self.assertIn('no_such_scene', response.message)
        self.assertEqual(self.client.get_state(), GoalStatus.ACTIVE)
        reached = self.states.messages[-1].tau
        self.assertTrue(self.states.wait(lambda states: states[-1].tau > reached), 'the trial goes on')

        self.assertTrue(self.load_scene('fig3').success)
        state, result = self.client.done()
        self.assertEqual((state, result.outcome), (GoalStatus.ABORTED, 'running'))
        self.assertIn('another scene', self.client.get_goal_status_text())
        self.assertTrue(self.states.wait(lambda states: states[-1].scene == 'fig3'))
        time.sleep(0.2)
        self.assertEqual(self.states.messages[-1].tau, 0.0, 'it waits at the start')
        with open(os.path.join(PACKAGE, 'config', 'scenes', 'fig3.yaml')) as file:
            press = yaml.safe_load(file)['gripper']['pressing_force']
        self.assertEqual(self.settings.get_configuration()['pressing_force'], press, 'with its own settings')

    def test_setting_enters_the_running_goal(self):
        self.client.send(scene=scene_path('small'), set_excitation=True, amplitude=0.0, frequency=20.0)
        self.assertTrue(self.client.running())
        self.assertEqual(sum(self.client.feedback[-1].impacts), 0)
        self.settings.update_configuration({'amplitude': 2.0})
        self.assertGreater(sum(self.client.done()[1].impacts), 0)

    def test_scene_without_excitation_and_change_of_scales(self):
        # another unit of time: samples keep their distance in seconds
        self.time_scale(0.05)
        self.client.send(scene='gripper_si', time_limit=0.005)
        self.assertEqual(self.client.done()[1].time, 0.005)
        # result and states come on connections of their own
        self.assertTrue(self.states.wait(lambda states: states[-1].time > 0.005 - 1e-12))
        times = [state.time for state in self.states.messages if state.scene == 'gripper_si']
        self.assertAlmostEqual(times[-1] - times[-2], 0.01 * TIME_UNIT, places=12)
        self.client.send(scene=scene_path('small'), time_limit=0.1)
        self.client.done()
        self.assertTrue(self.states.wait(lambda states: (states[-1].scene, states[-1].tau) == ('small', 0.1)))
        self.assertEqual([state.tau for state in self.states.messages[-3:-1]], [8 * 0.01, 9 * 0.01])


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'align', Align)
