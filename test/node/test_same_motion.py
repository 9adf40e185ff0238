#!/usr/bin/env python3
"""The node and `align trial` compute the same motion, bit for bit, and the same forces."""
import math

import rospy
import rostest

from aligner_test_case import AlignerTestCase, scene_path, trial_rows


class SameMotion(AlignerTestCase):

    def test_states_are_equal_bit_for_bit(self):
        states = self.listen('state')
        reactions = [self.listen('reaction/a1'), self.listen('reaction/a2')]
        self.run_to_end(states, *reactions)
        forces = [{message.header.stamp: message.wrench.force for message in listener.messages}
                  for listener in reactions]

        name = rospy.get_param('/aligner/scene/name')
        si = name.endswith('_si')
        rows = {row['t']: row for row in trial_rows(scene_path(name), rospy.get_param('/aligner/sample_interval'))}
        self.assertGreater(len(states.messages), 100)
        loaded = 0
        for i, state in enumerate(states.messages):
            row = rows.get(state.time if si else state.tau)
            self.assertIsNotNone(row, 'no row of the command line at the instant of sample %d' % i)
            motion = state.si if si else state.dimensionless
            for key in ('x', 'y', 'phi', 'vx', 'vy', 'omega'):
                self.assertEqual(getattr(motion, key), row[key], '%s of sample %d' % (key, i))
            unit = 1.0 if si else state.force_scale
            for number in (1, 2):
                force = forces[number - 1][state.header.stamp]
                self.assertEqual(force.y, 0.0)
                expected = math.hypot(row['n%d' % number], row['t%d' % number]) * unit
                self.assertAlmostEqual(math.hypot(force.x, force.z), expected, delta=1e-9 * (1.0 + expected))
                loaded += expected > 0.0
        self.assertGreater(loaded, 0, 'no sample in contact: the test shows nothing about forces')


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'same_motion', SameMotion)
