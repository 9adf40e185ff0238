#!/usr/bin/env python3
"""The tf2 tree."""
import math

import rospy
import rostest
import tf2_ros
from tf2_msgs.msg import TFMessage

from aligner_test_case import AlignerTestCase

SLOT_HALF_WIDTH = (0.7 + 0.09) * 2e-3  # of small.yaml [m]


class Transforms(AlignerTestCase):

    def test_tree_agrees_with_the_states(self):
        buffer = tf2_ros.Buffer(rospy.Duration(60.0))
        tf2_ros.TransformListener(buffer)
        moving, states = self.listen('/tf', TFMessage), self.listen('state')
        self.run_to_end(moving, states)

        for edge, side in (('edge_a1', 1.0), ('edge_a2', -1.0)):
            place = buffer.lookup_transform('world', edge, rospy.Time(0)).transform
            self.assertAlmostEqual(place.translation.x, side * SLOT_HALF_WIDTH, places=15)
            self.assertEqual((place.translation.y, place.translation.z, place.rotation.w), (0.0, 0.0, 1.0))

        stamps = [transform.header.stamp for message in moving.messages for transform in message.transforms]
        self.assertEqual(len(stamps), len(set(stamps)), 'a stamp was published twice')
        self.assertGreater(len(stamps), 100)

        parts = {transform.header.stamp: transform for message in moving.messages for transform in message.transforms}
        for state in states.messages:
            part = parts[state.header.stamp]
            self.assertEqual((part.header.frame_id, part.child_frame_id), ('slot', 'part'))
            place, turn = part.transform.translation, part.transform.rotation
            self.assertEqual((place.x, place.y, place.z), (state.si.x, 0.0, state.si.y))
            self.assertAlmostEqual(turn.y, -math.sin(state.si.phi / 2.0), places=12)
            self.assertAlmostEqual(turn.w, math.cos(state.si.phi / 2.0), places=12)
        self.assertTrue(buffer.can_transform('world', 'part', rospy.Time(0)))


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'transforms', Transforms)
