#!/usr/bin/env python3
"""The pace of the trial against the wall clock."""
import time

import dynamic_reconfigure.client
import rostest

from aligner_test_case import AlignerTestCase


class TimeScale(AlignerTestCase):

    def setUp(self):
        self.client = dynamic_reconfigure.client.Client('/aligner', timeout=15.0)
        self.states = self.listen('state')

    def run_at(self, time_scale):
        """Seconds of wall time from the first to the last state."""
        self.client.update_configuration({'time_scale': time_scale})
        self.run_to_end(self.states)
        return self.states.arrivals[-1] - self.states.arrivals[1]

    def test_pace_follows_the_scale(self):
        # 15 ms of simulated time
        self.assertAlmostEqual(self.run_at(0.01), 1.5, delta=0.4)
        self.assertAlmostEqual(self.run_at(0.005), 3.0, delta=0.4)

    def test_zero_is_as_fast_as_possible_with_the_same_samples(self):
        self.run_at(0.01)
        slow = [(state.tau, state.dimensionless) for state in self.states.messages]
        self.assertLess(self.run_at(0.0), 0.5)
        fast = [(state.tau, state.dimensionless) for state in self.states.messages]
        self.assertEqual(slow, fast)

    def test_the_end_does_not_wait_for_the_next_sample(self):
        self.node = '/seldom'  # a sample is due after every 4 s, the end after 1.5 s
        states, result = self.listen('state'), self.listen('result')
        self.assertTrue(states.wait_for(1))
        start = time.time()
        self.assertTrue(self.call('start').success)
        self.assertTrue(result.wait_for(1))
        self.assertAlmostEqual(result.arrivals[-1] - start, 1.5, delta=0.3)
        self.assertTrue(states.wait_for(2))
        self.assertEqual([state.tau for state in states.messages], [0.0, 3.0])

    def test_change_while_running_keeps_the_samples(self):
        self.client.update_configuration({'time_scale': 0.001})
        self.reset(self.states)
        self.call('start')
        self.assertTrue(self.states.wait_for(10))
        self.client.update_configuration({'time_scale': 0.1})
        self.assertTrue(self.states.wait_for(301, 5.0))
        for i, state in enumerate(self.states.messages[:300]):
            self.assertEqual(state.tau, i * 0.01)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'time_scale', TimeScale)
