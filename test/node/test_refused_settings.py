#!/usr/bin/env python3
"""Settings that cannot be used, sent past the client's own checks as any program can."""
import math

import rospy
import rostest
from dynamic_reconfigure.msg import Config, DoubleParameter, IntParameter
from dynamic_reconfigure.srv import Reconfigure

from aligner_test_case import AlignerTestCase


class RefusedSettings(AlignerTestCase):

    def setUp(self):
        rospy.wait_for_service('/aligner/set_parameters', 15.0)
        self.set = rospy.ServiceProxy('/aligner/set_parameters', Reconfigure)
        self.before = self.actual(self.set(Config()).config)

    @staticmethod
    def actual(config):
        return {parameter.name: parameter.value for parameter in config.doubles + config.ints + config.bools}

    def set_number(self, name, value):
        return self.actual(self.set(Config(doubles=[DoubleParameter(name, value)])).config)

    def test_nan_and_infinity_leave_the_old_value(self):
        for name in ('amplitude', 'frequency', 'phase', 'pressing_force', 'time_scale'):
            self.assertEqual(self.set_number(name, float('nan')), self.before)
        self.assertEqual(rospy.get_param('/aligner/amplitude'), self.before['amplitude'])

    def test_numbers_beyond_the_range_are_clamped_and_reported(self):
        for name, value, clamped in (('amplitude', -1.0, 0.0), ('frequency', 1e9, 10000.0),
                                     ('phase', 100.0, 2.0 * math.pi), ('time_scale', float('inf'), 1000.0)):
            self.assertAlmostEqual(self.set_number(name, value)[name], clamped, places=12)
            self.set_number(name, self.before[name])

    def test_waveforms_that_do_not_exist_are_clamped(self):
        config = self.actual(self.set(Config(ints=[IntParameter('waveform', -5)])).config)
        self.assertEqual(config['waveform'], 0)

    def test_chirp_without_a_sweep_is_refused(self):
        config = self.actual(self.set(Config(ints=[IntParameter('waveform', 99)])).config)
        self.assertEqual(config['waveform'], 0, '99 is clamped to the chirp')

    def test_trial_still_runs(self):
        self.set_number('amplitude', float('nan'))
        self.assertEqual(self.run_to_end().outcome, 'time_limit')


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'refused_settings', RefusedSettings)
