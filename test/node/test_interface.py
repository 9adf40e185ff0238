#!/usr/bin/env python3
"""The tables of docs/node.md against the running node."""
import os
import re
import subprocess

import rosgraph
import rospy
import rosservice
import rostest
from dynamic_reconfigure.msg import ConfigDescription
from roslib.message import get_message_class

from aligner_test_case import AlignerTestCase, Listener, program, scene_path

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..')


def tables():
    """Of the page: heading -> rows of its first table as dictionaries by column, without backquotes."""
    found, heading, columns = {}, '', None
    with open(os.path.join(ROOT, 'docs', 'node.md')) as page:
        for line in page:
            if line.startswith('## '):
                heading, columns = line[3:].split(' (')[0].strip(), None
            elif line.startswith('|'):
                cells = [cell.strip().replace('`', '') for cell in line.strip().strip('|').split('|')]
                if columns is None:
                    columns = cells
                    found.setdefault(heading, [])
                elif not cells[0].startswith('---'):
                    found[heading].append(dict(zip(columns, cells)))
    return found


def full_name(name):
    return name.replace('~', '/aligner/')


class Interface(AlignerTestCase):

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.tables = tables()
        rospy.wait_for_service('/aligner/step_by', 15.0)
        rospy.wait_for_service('/aligner/set_parameters', 15.0)
        cls.master = rosgraph.Master('/test_interface')
        cls.published, cls.subscribed, cls.services = (
            {name for name, nodes in entries if '/aligner' in nodes} for entries in cls.master.getSystemState())
        cls.types = dict(cls.master.getTopicTypes())

    def documented(self, heading, column):
        rows = {full_name(row[column]): row for row in self.tables[heading]}
        self.assertEqual(len(rows), len(self.tables[heading]), 'a row twice')
        return rows

    def check_types(self, heading, column, types):
        rows = self.documented(heading, column)
        self.assertEqual({name: row['type'] for name, row in rows.items()}, types)

    def test_published_topics(self):
        self.check_types('Topics that are published', 'topic', {name: self.types[name] for name in self.published})

    def test_frames_of_published_topics(self):
        rows = self.documented('Topics that are published', 'topic')
        with_frame = {topic: row['frame'] for topic, row in rows.items() if row['frame']}
        listeners = {topic: Listener(topic, get_message_class(rows[topic]['type'])) for topic in with_frame}
        self.run_to_end(listeners['/aligner/state'])
        for topic, frame in with_frame.items():
            self.assertTrue(listeners[topic].wait_for(1), topic)
            message = listeners[topic].messages[-1]
            for parts in ('markers', 'transforms'):
                message = getattr(message, parts, [message])[0]
            self.assertEqual(message.header.frame_id, frame, topic)

    def test_topics_that_are_read(self):
        self.check_types('Topics that are read', 'topic', {name: self.types[name] for name in self.subscribed})

    def test_services(self):
        self.check_types('Services', 'service', {name: rosservice.get_service_type(name) for name in self.services})

    def test_settings(self):
        descriptions = Listener('/aligner/parameter_descriptions', ConfigDescription)
        self.assertTrue(descriptions.wait_for(1))
        description = descriptions.messages[0]
        types = {parameter.name: parameter.type for group in description.groups for parameter in group.parameters}
        rows = {row['name']: row for row in self.tables['Settings']}
        self.assertEqual({name: row['type'] for name, row in rows.items()}, types)
        largest = {entry.name: entry.value for entry in description.max.doubles + description.max.ints}
        for entry in description.min.doubles + description.min.ints:
            least, most = rows[entry.name]['range'].split(' to ')
            self.assertAlmostEqual(float(least), entry.value, places=5, msg=entry.name)
            self.assertAlmostEqual(float(most), largest[entry.name], places=5, msg=entry.name)
        on_server = {name[len('/aligner/'):] for name in rospy.get_param_names() if name.startswith('/aligner/')}
        self.assertLessEqual(set(rows), on_server)

    def test_settings_start_with_the_scene_and_not_with_parameters(self):
        self.addCleanup(rospy.delete_param, '/given')
        process = subprocess.run((program('aligner_node'), '__name:=given', '_scene_file:=' + scene_path('small'),
                                  '_amplitude:=2.5', '_time_scale:=0', '_exit_when_done:=true'),
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=20, universal_newlines=True)
        self.assertEqual(process.returncode, 0)
        self.assertIn('/given/amplitude = 2.5 is not read at the start, the scene gives 1;', process.stdout)
        self.assertEqual(process.stdout.count('is not read'), 1)
        self.assertEqual(rospy.get_param('/given/amplitude'), 1.0)

    def test_parameters(self):
        rows = {row['name']: row for row in self.tables['Parameters']}
        # what is on the server: given by the launch file, or a setting
        settings = {row['name'] for row in self.tables['Settings']}
        given = {name.split('/')[2] for name in rospy.get_param_names() if name.startswith('/aligner/')}
        self.assertLessEqual(given, set(rows) | settings)
        # the node reads every one of them, and takes no map for any but the scene
        self.addCleanup(rospy.delete_param, '/picky')
        for name in set(rows) - {'scene', 'scene_file'}:
            rospy.set_param('/picky/' + name, {'no': 'value'})
        for name in settings - set(rows):  # as a node before has left them
            rospy.set_param('/picky/' + name, 1.0)
        process = subprocess.run((program('aligner_node'), '__name:=picky', '_scene_file:=' + scene_path('small')),
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=20, universal_newlines=True)
        self.assertEqual(process.returncode, 1)
        refused = set(re.findall(r'/picky/(\w+): ', process.stdout))
        self.assertEqual(refused, set(rows) - {'scene', 'scene_file'})
        self.assertNotIn('unknown parameter', process.stdout, 'it knows all of them, and the settings')
        # and it reads no other
        with open(os.path.join(ROOT, 'src', 'node', 'node_parameters.cpp')) as source:
            read = set(re.findall(r'(?:\.number|reader\.\w+)\(\s*"(\w+)"', source.read()))
        self.assertEqual(read, set(rows) - {'scene', 'scene_file'})


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'interface', Interface)
