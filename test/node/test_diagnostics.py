#!/usr/bin/env python3
"""What the node says of its health."""
import tempfile

import actionlib
import dynamic_reconfigure.client
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from aligner_test_case import AlignerTestCase, scene_path
from vibratory_alignment.msg import AlignAction, AlignGoal


class Diagnostics(AlignerTestCase):

    def setUp(self):
        self.settings = dynamic_reconfigure.client.Client('/aligner', timeout=15.0)
        self.settings.update_configuration({'time_scale': 0.01})
        self.reports = self.listen('/diagnostics', DiagnosticArray)
        self.call('reset')

    def next_report(self, count=2):
        """The next whole period, or a later one: a dictionary of values by name of the status, and the levels."""
        self.reports.forget(0)
        self.assertTrue(self.reports.wait_for(count, 6.0), 'no diagnostics')
        values, levels = {}, {}
        for status in self.reports.messages[-1].status:
            name = status.name.replace('aligner: ', '')
            values[name] = {entry.key: entry.value for entry in status.values}
            levels[name] = status.level
            values[name]['message'] = status.message
        self.assertEqual(set(levels), {'solver', 'pace', 'trial'})
        return values, levels

    def changed_scene(self, **sections):
        with open(scene_path('small')) as file:
            scene = yaml.safe_load(file)
        for key, section in sections.items():
            scene[key] = dict(scene.get(key, {}), **section) if isinstance(section, dict) else section
        file = tempfile.NamedTemporaryFile('w', suffix='.yaml')
        self.addCleanup(file.close)
        yaml.safe_dump(scene, file)
        file.flush()
        return file.name

    def align(self, **fields):
        client = actionlib.SimpleActionClient('/aligner/align', AlignAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(15.0)))
        client.send_goal(AlignGoal(**fields))
        return client

    def test_all_is_well_once_a_second(self):
        values, levels = self.next_report()
        self.assertEqual(set(levels.values()), {DiagnosticStatus.OK})
        self.assertEqual(values['trial']['message'], 'paused')
        self.settings.update_configuration({'time_scale': 0.002})  # 7.5 s
        self.call('start')
        values, levels = self.next_report(4)
        interval = (self.reports.arrivals[3] - self.reports.arrivals[0]) / 3
        self.assertAlmostEqual(interval, 1.0, delta=0.1)
        self.assertEqual(set(levels.values()), {DiagnosticStatus.OK})
        pace = values['pace']
        self.assertAlmostEqual(float(pace['simulated per wall time']), 0.002, delta=2e-4)
        # a sample every 0.01 of 5 ms
        self.assertAlmostEqual(float(pace['samples per second, asked for']), 40.0, places=6)
        self.assertAlmostEqual(float(pace['samples per second']), 40.0, delta=4.0)
        self.assertGreater(int(values['solver']['steps']), 0)
        self.assertLess(float(values['solver']['energy residual']), 1e-6)
        self.assertEqual((values['trial']['scene'], values['trial']['message']), ('small', 'running'))

    def test_trial_that_lags_behind_is_a_warning(self):
        # a million units of time, 1000 s a second: nobody can; the part is held where it is, and two excitations
        # whose frequencies have no common measure never settle
        self.settings.update_configuration({'time_scale': 1000.0})
        client = self.align(scene=self.changed_scene(
            trial={'time_limit': 1e6}, gripper={'stiffness': {'x': 1000.0, 'phi': 60.0}},
            excitation=[{'amplitude': 1.0, 'frequency': 20.0}, {'amplitude': 1.0, 'frequency': 1100.0 ** 0.5}]))
        values, levels = self.next_report()
        self.assertEqual(levels['pace'], DiagnosticStatus.WARN, values)
        self.assertIn('cannot keep up', values['pace']['message'])
        self.assertLess(float(values['pace']['simulated per wall time']), 500.0)
        self.assertGreater(float(values['pace']['simulated per wall time']), 0.0)
        self.assertEqual((levels['solver'], levels['trial']), (DiagnosticStatus.OK, DiagnosticStatus.OK))
        self.settings.update_configuration({'time_scale': 0.001})
        self.assertEqual(self.next_report()[1]['pace'], DiagnosticStatus.OK, 'and it is over with the lag')
        client.cancel_goal()

    def test_trial_that_fails_is_an_error(self):
        self.align(scene=self.changed_scene(solver={'step_limit': 5}))
        values, levels = self.next_report()
        self.assertEqual(levels['solver'], DiagnosticStatus.ERROR)
        self.assertIn('failed', values['solver']['message'])
        self.assertEqual(values['trial']['last outcome'], 'failed')
        self.assertEqual(values['solver']['trials failed'], '1')
        self.align(scene=scene_path('small'), time_limit=0.1)
        self.assertEqual(self.next_report()[1]['solver'], DiagnosticStatus.OK, 'until the next trial')


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'diagnostics', Diagnostics)
