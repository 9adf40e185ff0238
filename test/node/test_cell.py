#!/usr/bin/env python3
"""The example of a cell: what it reports is what the command line computes with the same settings."""
import json
import signal
import subprocess
import time

import dynamic_reconfigure.client
import rospy
import rostest
import yaml
from actionlib_msgs.msg import GoalStatus
from std_msgs.msg import String
from vibratory_alignment.msg import AlignActionFeedback, AlignActionResult

from aligner_test_case import AlignerTestCase, Listener, align, program

SETTINGS = {  # of config/cell.yaml, as the command line takes them
    'peg of the paper': ('fig2',),
    'steel peg, pressed gently': ('gripper_si', 'excitation.force=6', 'gripper.pressing_force=3',
                                  'trial.time_limit=0.5', 'trial.force_limit=50'),
    'peg into the bottom of its hole': ('insertion', 'gripper.pressing_force=0.25'),
}


class Cell(AlignerTestCase):

    def test_three_parts_in_sequence(self):
        self.assertTrue(program('cell.py'))
        reports = Listener('/cell/report', String)
        self.assertTrue(reports.wait_for(1, 40.0), 'no report')
        report = yaml.safe_load(reports.messages[0].data)
        self.assertEqual([part['part'] for part in report], list(SETTINGS))
        for part in report:
            scene, *settings = SETTINGS[part['part']]
            options = [word for setting in settings for word in ('--set', setting)]
            expected = json.loads(align('trial', scene, '--json', *options))
            self.assertIn(expected['outcome'], ('aligned', 'inserted'))
            self.assertEqual((part['state'], part['outcome']), ('succeeded', expected['outcome']))
            self.assertEqual(part['impacts'], sum(expected['impacts'].values()))
            self.assertLess(part['energy_residual'], 1e-6)
            time_unit, force_unit = (1.0, 1.0) if scene == 'gripper_si' else (5e-3, 8.0)
            self.assertAlmostEqual(part['aligned_ms'], 1e3 * expected['duration'] * time_unit, places=9)
            self.assertAlmostEqual(part['time_ms'], 1e3 * expected['final']['t'] * time_unit, places=9)
            self.assertAlmostEqual(part['peak_force'], max(expected['peak_force'].values()) * force_unit, places=9)

    def test_while_the_cell_stays_its_report_can_be_had(self):
        self.assertTrue(Listener('/cell/report', String).wait_for(1, 40.0), 'no report')
        time.sleep(1.5)  # as long as it would wait if it did not stay, and longer
        echo = subprocess.run(['rostopic', 'echo', '-n', '1', '/cell/report'], stdout=subprocess.PIPE,
                              universal_newlines=True, timeout=20.0)
        for part in SETTINGS:
            self.assertIn(part, echo.stdout)

    def test_faults_of_all_parts_are_told_before_the_first_is_aligned(self):
        rospy.set_param('/faulty/parts', [{'part': 'good', 'scene': 'fig2'},
                                          {'part': 'misspelt', 'scene': 'fig2', 'time_limt': 1.0},
                                          {'part': 'text', 'time_limit': 'long'}, {'time_limit': [1.0]}])
        cell = subprocess.run([program('cell.py'), '__name:=faulty'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              universal_newlines=True, timeout=20.0)
        self.assertEqual(cell.returncode, 1)
        self.assertNotIn('Traceback', cell.stdout)
        for words in ('/faulty/parts[1] (misspelt): time_limt: no field', "/faulty/parts[2] (text): time_limit: 'long'",
                      '/faulty/parts[3] (part): time_limit: [1.0]'):
            self.assertIn(words, cell.stdout)
        self.assertNotIn('good', cell.stdout)

    def test_time_that_is_up_gives_no_time_of_alignment(self):
        rospy.set_param('/late/parts', [{'part': 'late', 'scene': 'fig2', 'time_limit': 0.001}])
        reports = Listener('/late/report', String)
        cell = subprocess.run([program('cell.py'), '__name:=late'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              universal_newlines=True, timeout=60.0)
        self.assertEqual(cell.returncode, 1)
        self.assertIn('late: time_limit after 0.005 ms, not aligned, ', cell.stdout)
        self.assertTrue(reports.wait_for(1, 5.0))
        self.assertEqual(yaml.safe_load(reports.messages[0].data)[0]['aligned_ms'], None)

    def test_under_ctrl_c_the_goal_is_cancelled_and_no_other_part_begins(self):
        dynamic_reconfigure.client.Client('/aligner', timeout=15.0).update_configuration({'time_scale': 1e-6})
        rospy.set_param('/ended/parts', [{'part': 'one'}, {'part': 'two'}])
        feedback, result = Listener('/aligner/align/feedback', AlignActionFeedback), Listener('/aligner/align/result',
                                                                                             AlignActionResult)
        cell = subprocess.Popen([program('cell.py'), '__name:=ended'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                universal_newlines=True)
        self.assertTrue(feedback.wait_for(2, 20.0))
        cell.send_signal(signal.SIGINT)
        output = cell.communicate(timeout=20.0)[0]
        self.assertEqual(cell.returncode, 1)
        self.assertIn('interrupted', output)
        self.assertNotIn('two', output)
        self.assertTrue(result.wait_for(1, 5.0))
        self.assertEqual(result.messages[0].status.status, GoalStatus.PREEMPTED)
        time.sleep(0.5)
        self.assertEqual(len(result.messages), 1, 'no other goal')

    def test_patience_must_be_a_time(self):
        rospy.set_param('/hasty', {'parts': [{'part': 'one'}], 'patience': 'abc'})
        cell = subprocess.run([program('cell.py'), '__name:=hasty'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              universal_newlines=True, timeout=20.0)
        self.assertEqual(cell.returncode, 1)
        self.assertIn("/hasty/patience: must be a number > 0 [s]: 'abc'", cell.stdout)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'cell', Cell)
