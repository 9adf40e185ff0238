#!/usr/bin/env python3
"""Impacts last some hundredths, messages come every half: no sample need fall into an impact to show it."""
import os
import tempfile

import rosbag
import rostest

from aligner_test_case import AlignerTestCase, align, scene_path


class ShortImpact(AlignerTestCase):

    def test_peak_and_impulse_are_complete(self):
        states, reactions, contacts = self.listen('state'), self.listen('reaction/a1'), self.listen('contacts')
        self.run_to_end(states, reactions, contacts)
        forces = {message.header.stamp: message.wrench.force for message in reactions.messages}
        spots = {message.header.stamp: message.states for message in contacts.messages}

        unseen = [state for state in states.messages
                  if forces[state.header.stamp].z == 0.0 and state.peak_force[state.A1] > 0.0]
        self.assertTrue(unseen, 'every sample fell into an impact: the test shows nothing')
        for state in unseen:
            self.assertGreater(state.impulse[state.A1], 0.0)
            spot = [spot for spot in spots[state.header.stamp] if spot.info == 'a1'][0]
            self.assertEqual(spot.peak_force, state.peak_force[state.A1])
            self.assertGreater(spot.impulse.z, 0.0)

        # Nothing is lost: the same sum of impulses and the same peak as with fine samples.
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, 'fine.bag')
            align('trial', scene_path('small'), '--bag', path, '--sample', '0.001')
            with rosbag.Bag(path) as bag:
                fine = [message for _, message, _ in bag.read_messages(topics=['/aligner/state'])]
        for spot in (0, 1):
            total, expected = (sum(state.impulse[spot] for state in run) for run in (states.messages, fine))
            self.assertAlmostEqual(total, expected, delta=1e-9 * (1e-3 + expected))
            highest, expected = (max(state.peak_force[spot] for state in run) for run in (states.messages, fine))
            self.assertAlmostEqual(highest, expected, delta=1e-9 * (1.0 + expected))


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'short_impact', ShortImpact)
