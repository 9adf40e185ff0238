#!/usr/bin/env python3
"""The paper's trial through trial.launch."""
import rostest

from aligner_test_case import AlignerTestCase


class Trial(AlignerTestCase):

    def test_part_aligns(self):
        states = self.listen('state')
        result = self.run_to_end(states)
        self.assertEqual((result.scene, result.outcome), ('fig2', 'aligned'))
        self.assertGreater(result.duration, 0.0)
        self.assertGreater(sum(result.impacts), 0)
        self.assertTrue(result.first_contact.happened)
        self.assertLess(result.energy.residual, 1e-6)
        last = states.messages[-1]
        self.assertEqual(last.tau, result.tau)
        self.assertEqual(last.dimensionless, result.dimensionless)
        self.assertLess(last.misalignment, states.messages[0].misalignment)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'trial', Trial)
