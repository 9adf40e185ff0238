#!/usr/bin/env python3
"""Two aligners side by side."""
import rospy
import rostest
import tf2_ros
from diagnostic_msgs.msg import DiagnosticArray
from dynamic_reconfigure.client import Client

from aligner_test_case import AlignerTestCase

SIDES = ('left', 'right')


class TwoAligners(AlignerTestCase):

    def test_they_run_at_once_and_know_nothing_of_each_other(self):
        states, results = {}, {}
        for side in SIDES:
            self.node = '/%s/aligner' % side
            states[side], results[side] = self.listen('state'), self.listen('result')
            self.reset(states[side])
        Client('/right/aligner', timeout=15.0).update_configuration({'pressing_force': 0.3})
        for side in SIDES:
            self.node = '/%s/aligner' % side
            self.assertTrue(self.call('start').success)
        for side in SIDES:
            self.assertTrue(results[side].wait_for(1), side)
            self.assertTrue(states[side].wait(lambda messages: messages[-1].tau == 3.0))
        poses = {side: [state.dimensionless.y for state in states[side].messages] for side in SIDES}
        self.assertEqual(len(poses['left']), len(poses['right']))
        self.assertNotEqual(poses['left'], poses['right'], 'the setting of one is that of one')
        frames = {side: states[side].messages[0].header.frame_id for side in SIDES}
        self.assertEqual(frames, {'left': 'left/slot', 'right': 'right/slot'})
        both = [self.listen('/%s/aligner/state' % side, type(states[side].messages[0])) for side in SIDES]
        self.assertEqual(len(both), 2)
        diagnostics = self.listen('/diagnostics', DiagnosticArray)
        self.assertTrue(diagnostics.wait(lambda messages: {
            status.name for message in messages for status in message.status} >= {
                '%s/aligner: pace' % side for side in SIDES}, 5.0))

    def test_each_has_its_own_frames_in_one_tree(self):
        buffer = tf2_ros.Buffer(rospy.Duration(60.0))
        tf2_ros.TransformListener(buffer)
        for side in SIDES:
            self.node = '/%s/aligner' % side
            self.run_to_end()
        edge = buffer.lookup_transform('left/slot', 'right/edge_a1', rospy.Time(0)).transform.translation
        self.assertAlmostEqual(edge.x, 0.02 + 0.79 * 2e-3, places=12)
        self.assertEqual(edge.z, 0.0)
        height = buffer.lookup_transform('world', 'left/part', rospy.Time(0)).transform.translation.z
        self.assertGreater(height, 0.5)
        frames = buffer.all_frames_as_yaml()
        for frame in ('slot', 'part', 'edge_a1', 'edge_a2'):
            self.assertNotIn('\n%s:' % frame, '\n' + frames, 'a frame without prefix')


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'two_aligners', TwoAligners)
