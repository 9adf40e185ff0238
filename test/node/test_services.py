#!/usr/bin/env python3
"""The services ~start, ~pause, ~step and ~reset."""
import tempfile
import time

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from tf2_msgs.msg import TFMessage

from aligner_test_case import AlignerTestCase, Newcomer, scene_path
from vibratory_alignment.msg import AlignerContacts, AlignerState
from vibratory_alignment.srv import LoadScene

INTERVAL = 0.01


class Services(AlignerTestCase):

    def setUp(self):
        self.states = self.listen('state')
        self.reset(self.states)
        self.states.forget(0)

    def test_nothing_moves_before_the_start(self):
        time.sleep(0.5)
        self.assertEqual(self.states.messages, [])

    def test_step_is_one_sample(self):
        for count in (1, 2, 3):
            response = self.call('step')
            self.assertTrue(response.success, response.message)
            self.assertTrue(self.states.wait_for(count))
        time.sleep(0.3)
        self.assertEqual([state.tau for state in self.states.messages], [1 * INTERVAL, 2 * INTERVAL, 3 * INTERVAL])

    def test_pause_stops_and_start_goes_on_without_a_gap(self):
        self.assertTrue(self.call('start').success)
        self.assertTrue(self.states.wait_for(20))
        self.assertTrue(self.call('pause').success)
        time.sleep(0.2)
        count = len(self.states.messages)
        time.sleep(0.5)
        self.assertEqual(len(self.states.messages), count, 'published while paused')
        self.assertTrue(self.call('start').success)
        self.assertTrue(self.states.wait_for(count + 20))
        self.call('pause')
        for i, state in enumerate(self.states.messages):
            self.assertEqual(state.tau, (i + 1) * INTERVAL)

    def join(self, topic, kind):
        newcomer = Newcomer(topic, kind)
        self.addCleanup(newcomer.close)
        return newcomer

    def test_who_joins_at_a_standstill_gets_the_last_sample_and_nobody_gets_it_twice(self):
        kinds = {'contacts': AlignerContacts, 'reaction/a1': WrenchStamped, 'reaction/a2': WrenchStamped}
        others = {topic: self.listen(topic) for topic in kinds}
        self.reset(self.states, *others.values())
        self.step_by(samples=3)
        listeners = dict(others, state=self.states)
        for topic, listener in listeners.items():
            self.assertTrue(listener.wait_for(4))
            newcomer = self.join('/aligner/' + topic, kinds.get(topic, AlignerState))
            given, last = newcomer.next(), listener.messages[-1]
            given.header.seq = last.header.seq
            self.assertEqual(given, last, topic)
            self.assertIsNone(newcomer.next(0.3), topic)
            self.assertEqual(len(listener.messages), 4, 'given to the newcomer alone')
        newcomer = self.join('/aligner/state', AlignerState)
        instants = [newcomer.next().tau]
        self.assertTrue(self.call('start').success)
        instants += [newcomer.next().tau for _ in range(19)]
        self.assertEqual(instants, [i * INTERVAL for i in range(3, 23)], 'without a gap or a repeat')

    def test_pose_is_told_again_at_a_standstill(self):
        self.step_by(samples=3)
        self.assertTrue(self.states.wait_for(3))
        last = self.states.messages[-1]
        newcomer = self.join('/tf', TFMessage)
        transforms = [newcomer.next().transforms[0] for _ in range(3)]
        for transform in transforms:
            place = transform.transform.translation
            self.assertEqual((transform.child_frame_id, place.x, place.z), ('part', last.si.x, last.si.y))
        stamps = [last.header.stamp] + [transform.header.stamp for transform in transforms]
        for earlier, later in zip(stamps, stamps[1:]):
            self.assertLess(earlier, later)
        self.assertAlmostEqual((stamps[3] - stamps[2]).to_sec(), 1.0, delta=0.3)
        self.assertEqual(len(self.states.messages), 3, 'that is no sample')

    def test_step_pauses_a_running_trial(self):
        self.call('start')
        self.assertTrue(self.states.wait_for(5))
        self.assertTrue(self.call('step').success)
        time.sleep(0.2)
        count = len(self.states.messages)
        time.sleep(0.3)
        self.assertEqual(len(self.states.messages), count)

    def test_step_by_samples_and_by_duration(self):
        for request, count in ((dict(samples=3), 3), (dict(duration=0.0251), 3), (dict(duration=0.005001), 1),
                               (dict(samples=200), 200)):
            before = len(self.states.messages)
            response = self.step_by(**request)
            self.assertTrue(response.success, response.message)
            self.assertEqual(response.samples, count)
            self.assertTrue(self.states.wait_for(before + count, 2.0), 'published before the answer')
        time.sleep(0.3)
        self.assertEqual([state.tau for state in self.states.messages], [n * INTERVAL for n in range(1, 208)])

    def test_step_by_ends_with_the_trial(self):
        response = self.step_by(samples=1000)
        self.assertEqual((response.success, response.samples), (True, 300))
        self.assertFalse(self.step_by(samples=1).success)
        self.assertTrue(self.states.wait_for(300))
        self.assertEqual(self.states.messages[-1].tau, 3.0)

    def load(self, scene):
        response = rospy.ServiceProxy('/aligner/load_scene', LoadScene)(scene)
        self.assertTrue(response.success, response.message)
        return response.message

    def load_text(self, text):
        """Loads a scene of this test alone."""
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
            file.write(text)
            file.flush()
            self.addCleanup(self.load, scene_path('small'))
            return self.load(file.name)

    def test_trial_that_fails_in_its_first_step_ends(self):
        results, markers = self.listen('result'), self.listen('markers')
        with open(scene_path('small')) as small:
            text = small.read().replace('frequency: 20.0', 'frequency: 1.0e+100')
        before = len(results.messages)
        self.assertIn('fails at the start: the motion is no longer finite', self.load_text(text))
        for reset in (False, True):
            if reset:
                self.assertIn('fails at the start', self.call('reset').message)
            before += 1
            self.assertTrue(results.wait_for(before))
            result = results.messages[-1]
            self.assertEqual((result.outcome, result.tau), ('failed', 0.0))
            self.assertGreater(result.header.stamp.to_sec(), 0.0)
            self.assertTrue(markers.wait(lambda messages: messages[-1].markers[0].header.stamp == result.header.stamp))
            self.assertFalse(self.call('start').success)
            self.assertFalse(self.call('step').success)
        self.load(scene_path('small'))
        self.assertEqual(self.step_by(samples=1).samples, 1)

    def test_step_by_that_takes_long_gives_others_their_turn(self):
        with open(scene_path('small')) as small:
            self.load_text(small.read() + 'solver: {name: rk4, step: 1.0e-7, step_limit: 1000000000}\n')
        self.assertTrue(self.states.wait_for(1))
        self.states.forget(0)
        published = 0
        for _ in range(2):
            start = time.time()
            response = self.step_by(samples=300)
            self.assertLess(time.time() - start, 4.0)
            self.assertTrue(response.success)
            self.assertIn('ask again', response.message)
            self.assertLess(response.samples, 300)
            published += response.samples
        self.assertGreater(published, 0)
        self.assertTrue(self.states.wait_for(published))
        self.assertEqual([state.tau for state in self.states.messages], [n * INTERVAL for n in range(1, published + 1)])

    def test_step_by_refuses_what_it_cannot_do(self):
        for request in (dict(), dict(samples=1001), dict(duration=-1.0), dict(duration=0.004), dict(duration=1e3),
                        dict(duration=float('nan')), dict(duration=float('inf'))):
            response = self.step_by(**request)
            self.assertEqual((response.success, response.samples), (False, 0), request)
            self.assertIn('1 to 1000', response.message)
        self.assertIn('give one', self.step_by(samples=1, duration=1.0).message)
        time.sleep(0.2)
        self.assertEqual(self.states.messages, [])

    def test_reset_and_start_are_announced(self):
        restarts = self.listen('restarts')
        self.assertTrue(restarts.wait_for(1), 'it is latched')
        count = restarts.messages[-1].data
        self.call('reset')
        self.assertTrue(restarts.wait(lambda messages: messages[-1].data == count + 1))

    def test_reset_repeats_the_trial(self):
        self.run_to_end(self.states)
        first = [state for state in self.states.messages]
        self.assertFalse(self.call('start').success, 'the trial has ended')
        self.assertFalse(self.call('step').success)
        self.run_to_end(self.states)
        self.assertEqual([(s.tau, s.dimensionless) for s in first],
                         [(s.tau, s.dimensionless) for s in self.states.messages])

    def test_reset_deletes_the_picture(self):
        markers = self.listen('markers')
        self.call('reset')
        self.assertTrue(markers.wait(lambda messages: any(
            marker.action == marker.DELETEALL for message in messages for marker in message.markers)))


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'services', Services)
