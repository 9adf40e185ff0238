"""What the rostests of the node share: messages as they come, services, and `align trial` for comparison."""

import csv
import io
import os
import socket
import struct
import subprocess
import tempfile
import threading
import time
import unittest
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
from geometry_msgs.msg import WrenchStamped
from rosgraph.network import read_ros_handshake_header, write_ros_handshake_header
from roslib.packages import find_node
from std_msgs.msg import UInt32
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from vibratory_alignment.msg import AlignerContacts, AlignerResult, AlignerState
from vibratory_alignment.srv import StepBy

SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'scenes')


def scene_path(name):
    return os.path.join(SCENES, name + '.yaml')


class Listener:
    """Keeps every message of a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self.arrivals = []
        self._changed = threading.Condition()
        self.subscriber = rospy.Subscriber(topic, kind, self._on_message, queue_size=10000, tcp_nodelay=True)

    def _on_message(self, message):
        with self._changed:
            self.messages.append(message)
            self.arrivals.append(time.time())
            self._changed.notify_all()

    def forget(self, kept):
        """Keeps the last `kept` messages."""
        with self._changed:
            start = len(self.messages) - kept
            del self.messages[:start], self.arrivals[:start]

    def wait(self, condition, timeout=15.0):
        """Waits until condition(messages); True if it came true in time."""
        deadline = time.time() + timeout
        with self._changed:
            while not condition(self.messages):
                if not self._changed.wait(max(0.0, deadline - time.time())) and time.time() >= deadline:
                    return False
        return True

    def wait_for(self, count, timeout=15.0):
        return self.wait(lambda messages: len(messages) >= count, timeout)


class Newcomer:
    """A subscriber with a connection of its own; rospy has one for all subscribers of a process."""

    def __init__(self, topic, kind):
        uri = rosgraph.Master('/newcomer').lookupNode('/aligner')
        _, _, (_, host, port) = ServerProxy(uri).requestTopic('/newcomer', topic, [['TCPROS']])
        self._socket = socket.create_connection((host, port))
        self._kind = kind
        write_ros_handshake_header(self._socket, {'callerid': '/newcomer', 'topic': topic, 'type': kind._type,
                                                  'md5sum': kind._md5sum})
        received = io.BytesIO()
        read_ros_handshake_header(self._socket, received, 65536)
        self._received = received.getvalue()  # beyond the header

    def _read(self, size):
        while len(self._received) < size:
            part = self._socket.recv(65536)
            if not part:
                raise ConnectionError('the node has closed the connection')
            self._received += part
        data, self._received = self._received[:size], self._received[size:]
        return data

    def next(self, timeout=2.0):
        """The next message; None: there is none in time."""
        self._socket.settimeout(timeout)
        try:
            return self._kind().deserialize(self._read(*struct.unpack('<I', self._read(4))))
        except socket.timeout:
            return None

    def close(self):
        self._socket.close()


class AlignerTestCase(unittest.TestCase):
    """A node that waits for the service start."""

    node = '/aligner'

    @classmethod
    def setUpClass(cls):
        if not rospy.core.is_initialized():
            rospy.init_node('test_aligner', anonymous=True)

    def listen(self, topic, kind=None):
        """Listens to a topic of the node, from when the node has connected."""
        kinds = {'state': AlignerState, 'contacts': AlignerContacts, 'result': AlignerResult,
                 'markers': MarkerArray, 'restarts': UInt32, 'reaction/a1': WrenchStamped, 'reaction/a2': WrenchStamped}
        listener = Listener(topic if kind else self.node + '/' + topic, kind or kinds[topic])
        deadline = time.time() + 15.0
        while listener.subscriber.get_num_connections() == 0:
            self.assertLess(time.time(), deadline, topic + ' is not published')
            time.sleep(0.02)
        return listener

    def call(self, service):
        rospy.wait_for_service(self.node + '/' + service, 15.0)
        return rospy.ServiceProxy(self.node + '/' + service, Trigger)()

    def step_by(self, samples=0, duration=0.0):
        rospy.wait_for_service(self.node + '/step_by', 15.0)
        return rospy.ServiceProxy(self.node + '/step_by', StepBy)(samples, duration)

    def reset(self, *listeners):
        """Goes back to the start; each listener then holds the one message of it."""
        for _ in range(10):  # the node may know a new listener a little later than the listener the node
            for listener in listeners:
                listener.forget(0)
            self.assertTrue(self.call('reset').success)
            if all(listener.wait_for(1, 2.0) for listener in listeners):
                time.sleep(0.1)
                for listener in listeners:
                    listener.forget(1)
                return
        self.fail('not every topic has a message after the reset')

    def run_to_end(self, *listeners):
        """Resets the trial, runs it and returns its result; the listeners then hold all of the trial."""
        self.reset(*listeners)
        result = self.listen('result')
        time.sleep(0.3)  # a latched result of an earlier run is here by now
        earlier = len(result.messages)
        self.assertTrue(self.call('start').success)
        self.assertTrue(result.wait_for(earlier + 1, 30.0), 'no result')
        time.sleep(0.3)
        return result.messages[-1]


def program(name):
    """Path of a program of the package in the build that is tested."""
    return find_node('vibratory_alignment', name)[0]


def align(*arguments):
    """Output of the command line."""
    return subprocess.check_output((program('align'),) + arguments, universal_newlines=True)


def trial_rows(scene, sample):
    """Rows of `align trial --csv` as dictionaries of numbers, in the scene's own units."""
    with tempfile.TemporaryDirectory() as directory:
        path = os.path.join(directory, 'trial.csv')
        align('trial', scene, '--csv', path, '--sample', repr(sample))
        with open(path) as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
