#!/usr/bin/env python3
"""Settings change the running trial."""
import dynamic_reconfigure.client
import rostest

from aligner_test_case import AlignerTestCase


class Reconfigure(AlignerTestCase):

    def setUp(self):
        self.client = dynamic_reconfigure.client.Client('/aligner', timeout=15.0)
        self.client.update_configuration(
            {'enabled': True, 'amplitude': 1.0, 'frequency': 20.0, 'pressing_force': 0.2, 'time_scale': 0.01})
        self.states = self.listen('state')
        self.reset(self.states)

    def step(self, count):
        for _ in range(count):
            expected = len(self.states.messages) + 1
            self.call('step')
            self.assertTrue(self.states.wait_for(expected))
        return [state.dimensionless for state in self.states.messages]

    def test_starts_with_the_values_of_the_scene(self):
        config = self.client.get_configuration()
        self.assertEqual((config['amplitude'], config['frequency'], config['phase'], config['pressing_force']),
                         (1.0, 20.0, 0.0, 0.2))

    def test_change_enters_at_the_last_sample_and_not_before(self):
        undisturbed = self.step(40)
        self.reset(self.states)
        self.step(20)
        self.client.update_configuration({'amplitude': 2.0})
        disturbed = self.step(20)
        self.assertEqual(undisturbed[:21], disturbed[:21])
        self.assertNotEqual(undisturbed[21], disturbed[21])

    def test_same_change_gives_the_same_motion(self):
        motions = []
        for _ in range(2):
            self.reset(self.states)
            self.step(15)
            self.client.update_configuration({'frequency': 25.0})
            motions.append(self.step(25))
            self.client.update_configuration({'frequency': 20.0})
        self.assertEqual(motions[0], motions[1])

    def test_disabled_excitation_lets_the_part_come_to_rest(self):
        self.client.update_configuration({'enabled': False, 'time_scale': 0.0})
        result = self.run_to_end(self.states)
        speeds = [abs(state.dimensionless.vy) for state in self.states.messages[-10:]]
        self.assertLess(max(speeds), 0.02)
        self.assertNotEqual(result.outcome, 'failed')

    def test_values_stay_after_reset(self):
        self.client.update_configuration({'pressing_force': 0.5})
        self.reset(self.states)
        pressed = self.states.messages[0].dimensionless.y
        self.client.update_configuration({'pressing_force': 0.2})
        self.reset(self.states)
        self.assertLess(pressed, self.states.messages[0].dimensionless.y, 'it starts in equilibrium with the force')


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'reconfigure', Reconfigure)
