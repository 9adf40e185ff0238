#!/usr/bin/env python3
"""Stamps while ROS time stands still at 0."""
import rostest

from aligner_test_case import AlignerTestCase


class SimTime(AlignerTestCase):

    def test_stamps_rise_from_above_zero(self):
        states = self.listen('state')
        self.run_to_end(states)
        stamps = [state.header.stamp for state in states.messages]
        self.assertGreater(len(stamps), 100)
        self.assertGreater(stamps[0].to_nsec(), 0)
        for earlier, later in zip(stamps, stamps[1:]):
            self.assertLess(earlier, later)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'sim_time', SimTime)
