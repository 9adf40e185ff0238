#!/usr/bin/env python3
"""The view that view_trial hands to rviz: of the aligner that is asked for, where it is, and as large as it is."""
import os
import subprocess
import tempfile

import rosbag
import rospkg
import rostest
import yaml
from tf2_msgs.msg import TFMessage

from aligner_test_case import AlignerTestCase, Listener, program
from vibratory_alignment.msg import AlignerState

HALF_WIDTHS = {'left': 0.79 * 2e-3, 'right': 0.44 * 2e-3}


class View(AlignerTestCase):

    def view(self, *arguments, **environment):
        """The .rviz file that rviz would be given."""
        with tempfile.TemporaryDirectory() as directory:
            rosrun = os.path.join(directory, 'rosrun')  # in place of that which starts rviz
            with open(rosrun, 'w') as file:
                file.write('#!/bin/sh\ncat "$4"\nrm "$4"\n')
            os.chmod(rosrun, 0o755)
            path = directory + os.pathsep + os.environ['PATH']
            return yaml.safe_load(subprocess.check_output(
                (program('view_trial'),) + arguments, env=dict(os.environ, PATH=path, **environment)))

    def assert_shows(self, config, side):
        camera = config['Visualization Manager']['Views']['Current']
        self.assertEqual(camera['Target Frame'], side + '/slot')
        self.assertAlmostEqual(camera['Distance'] / HALF_WIDTHS[side], 9.5, delta=0.1)
        panel = next(panel for panel in config['Panels'] if panel['Class'].endswith('/AlignerPanel'))
        self.assertEqual(panel['Node'], '/%s/aligner' % side)
        topics = [display['Marker Topic'] for display in config['Visualization Manager']['Displays']
                  if 'Marker Topic' in display]
        self.assertEqual(topics, ['/%s/aligner/markers' % side])

    def test_is_of_the_aligner_that_is_asked_for(self):
        for side in HALF_WIDTHS:
            self.assert_shows(self.view('/%s/aligner' % side), side)

    def test_file_for_rviz_fits_fig2_as_it_is(self):
        with open(os.path.join(rospkg.RosPack().get_path('vibratory_alignment'), 'rviz', 'aligner.rviz')) as file:
            drawn = yaml.safe_load(file)['Visualization Manager']['Views']['Current']
        fitted = self.view('/right/aligner')['Visualization Manager']['Views']['Current']
        for length in ('Distance', 'Near Clip Distance'):
            self.assertAlmostEqual(fitted[length] / drawn[length], 1.0, places=9)

    def test_name_is_one_of_the_namespace(self):
        for side in HALF_WIDTHS:
            self.assert_shows(self.view('aligner', ROS_NAMESPACE='/' + side), side)

    def test_is_of_the_aligner_in_the_bag_that_is_asked_for(self):
        states = {side: Listener('/%s/aligner/state' % side, AlignerState) for side in HALF_WIDTHS}
        static = Listener('/tf_static', TFMessage)
        for listener in list(states.values()) + [static]:
            self.assertTrue(listener.wait_for(2 if listener is static else 1))
        with tempfile.NamedTemporaryFile(suffix='.bag') as file:
            with rosbag.Bag(file.name, 'w') as bag:
                for message in static.messages:
                    bag.write('/tf_static', message)
                for side, listener in states.items():
                    bag.write('/%s/aligner/state' % side, listener.messages[0])
            for side in HALF_WIDTHS:
                self.assert_shows(self.view('/%s/aligner' % side, '--bag', file.name), side)
            self.assert_refuses('no aligner /other in it, but /left/aligner, /right/aligner', '/other', '--bag', file.name)

    def assert_refuses(self, words, *arguments):
        process = subprocess.run((program('view_trial'),) + arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 universal_newlines=True)
        self.assertEqual(process.returncode, 1)
        self.assertNotIn('Traceback', process.stderr)
        self.assertIn(words, process.stderr)

    def test_files_that_are_no_bag_are_refused(self):
        self.assert_refuses('/no/such.bag: ', '--bag', '/no/such.bag')
        self.assert_refuses(__file__ + ': ', '--bag', __file__)

    def test_each_aligner_has_an_rviz_of_its_own(self):
        for name in ('first', 'second'):
            nodes = subprocess.check_output(['roslaunch', '--nodes', 'vibratory_alignment', 'trial.launch', 'rviz:=true',
                                             'name:=' + name], universal_newlines=True)
            self.assertEqual(set(nodes.split()), {'/' + name, '/rviz_' + name})


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'view', View)
