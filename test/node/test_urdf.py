#!/usr/bin/env python3
"""urdf/fig2.urdf: fits the scene, and robot_state_publisher leaves the moving part to the aligner."""
import os
import shutil
import subprocess
import time
import unittest
import xml.etree.ElementTree

import rosgraph
import rospy
import rostest
import tf2_ros
import yaml
from roslib.packages import find_node
from tf2_msgs.msg import TFMessage

from aligner_test_case import AlignerTestCase, Listener

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FILE = os.path.join(ROOT, 'urdf', 'fig2.urdf')


def boxes(link):
    """Maps the name of each box of a link to ((centre), (size)); visual and collision alike."""
    found = {}
    for kind in ('visual', 'collision'):
        for body in link.iter(kind):
            box = tuple(tuple(float(word) for word in text.split()) for text in
                        (body.find('origin').get('xyz'), body.find('geometry/box').get('size')))
            if found.setdefault(body.get('name'), box) != box:
                raise ValueError(body.get('name') + ': visual and collision differ')
    return found


class Urdf(AlignerTestCase):

    def setUp(self):
        robot = xml.etree.ElementTree.parse(FILE).getroot()
        links = {link.get('name'): boxes(link) for link in robot.iter('link')}
        (self.right, self.left), (self.part,) = links['slot'].values(), links['part'].values()

    def test_sizes_are_those_of_the_scene(self):
        with open(os.path.join(ROOT, 'config', 'scenes', 'fig2.yaml')) as file:
            scene = yaml.safe_load(file)
        length = scene['scales']['force'] / scene['scales']['stiffness']
        centre, size = self.part
        self.assertAlmostEqual(size[0], 2 * scene['part']['half_width'] * length, places=9)
        self.assertAlmostEqual(centre[2] - size[2] / 2, -scene['part']['base_distance'] * length, places=9)

    def test_base_lies_at_the_edges_of_the_node(self):
        buffer = tf2_ros.Buffer()
        tf2_ros.TransformListener(buffer)
        for (centre, size), frame, side in ((self.right, 'edge_a1', -1), (self.left, 'edge_a2', 1)):
            edge = buffer.lookup_transform('slot', frame, rospy.Time(0), rospy.Duration(10.0)).transform.translation
            self.assertAlmostEqual(centre[0] + side * size[0] / 2, edge.x, places=9)
            self.assertAlmostEqual(centre[2] + size[2] / 2, edge.z, places=9)

    @unittest.skipUnless(shutil.which('check_urdf'), 'check_urdf (liburdfdom-tools) is not here')
    def test_is_a_valid_urdf(self):
        output = subprocess.check_output(['check_urdf', FILE], universal_newlines=True)
        self.assertIn('Successfully Parsed XML', output)

    @unittest.skipUnless(find_node('robot_state_publisher', 'robot_state_publisher'),
                         'robot_state_publisher is not here')
    def test_robot_state_publisher_leaves_the_part_to_the_aligner(self):
        with open(FILE) as file:
            rospy.set_param('/robot_description', file.read())
        publisher = subprocess.Popen(find_node('robot_state_publisher', 'robot_state_publisher'))
        self.addCleanup(publisher.wait)
        self.addCleanup(publisher.terminate)
        static, moving = Listener('/tf_static', TFMessage), Listener('/tf', TFMessage)
        deadline = time.time() + 15.0
        while '/robot_state_publisher' not in self.publishers('/tf') and time.time() < deadline:
            time.sleep(0.1)
        self.run_to_end(self.listen('state'))
        self.assertEqual(publisher.poll(), None, 'it runs')
        for message in static.messages + moving.messages:
            for transform in message.transforms:
                if transform.child_frame_id == 'part':
                    self.assertEqual(message._connection_header['callerid'], '/aligner')
        self.assertIn('/robot_state_publisher', self.publishers('/tf'), 'it could have')

    @staticmethod
    def publishers(topic):
        state = dict(rosgraph.Master('/test').getSystemState()[0])
        return state.get(topic, [])


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'urdf', Urdf)
