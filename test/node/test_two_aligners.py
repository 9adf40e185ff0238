#!/usr/bin/env python3
"""Two aligners side by side."""
import rospy
import rostest
import tf2_ros

from aligner_test_case import AlignerTestCase


class TwoAligners(AlignerTestCase):

    def test_each_has_its_own_frames_in_one_tree(self):
        buffer = tf2_ros.Buffer(rospy.Duration(60.0))
        tf2_ros.TransformListener(buffer)
        for side in ('left', 'right'):
            self.node = '/%s_aligner' % side
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
