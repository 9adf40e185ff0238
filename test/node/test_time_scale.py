#!/usr/bin/env python3
"""The pace of the trial against the wall clock."""
import os
import signal
import time
from xmlrpc.client import ServerProxy

import dynamic_reconfigure.client
import rosgraph
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

    def test_a_node_that_was_held_up_sends_no_burst_but_every_sample(self):
        self.client.update_configuration({'time_scale': 0.002})  # 40 samples a second, of which 300 are the trial
        self.reset(self.states)
        self.call('start')
        self.assertTrue(self.states.wait_for(20))
        node = ServerProxy(rosgraph.Master('/test_time_scale').lookupNode('/aligner')).getPid('/test_time_scale')[2]
        os.kill(node, signal.SIGSTOP)
        time.sleep(3.0)
        before = len(self.states.messages)
        os.kill(node, signal.SIGCONT)
        time.sleep(1.0)
        self.assertLess(len(self.states.messages) - before, 80, 'not the 120 of three seconds at once')
        self.client.update_configuration({'time_scale': 0.1})
        self.assertTrue(self.states.wait_for(301, 15.0))
        self.assertEqual([state.tau for state in self.states.messages], [i * 0.01 for i in range(301)])


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'time_scale', TimeScale)
