#!/usr/bin/env python3
"""The golden bag, replay.launch, and what is left when a recorder is killed or its disk is full."""
import os
import signal
import subprocess
import tempfile
import time
import xmlrpc.client

import rosbag
import rosgraph
import rospy
import rostest
from dynamic_reconfigure.msg import Config
from geometry_msgs.msg import WrenchStamped
from std_msgs.msg import UInt32
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from aligner_test_case import AlignerTestCase, Listener, align, scene_path
from bag_reader import difference, picture, plain, read, types
from vibratory_alignment.msg import AlignerContacts, AlignerResult, AlignerState

GOLDEN = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'bags', 'small.bag')
TOPICS = ['/aligner/' + name for name in ('contacts', 'markers', 'parameter_updates', 'reaction/a1', 'reaction/a2',
                                          'restarts', 'result', 'state')] + ['/tf', '/tf_static']
CHUNK = 64 * 1024


class Bags(AlignerTestCase):

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = directory.name

    def path(self, name):
        return os.path.join(self.directory, name)

    def launch(self, *arguments, **options):
        process = subprocess.Popen(('roslaunch', 'vibratory_alignment') + arguments, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, universal_newlines=True, **options)

        def end():
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
            process.communicate(timeout=90.0)

        self.addCleanup(end)
        return process

    def test_golden_bag_is_what_a_trial_writes_today(self):
        fresh = self.path('fresh.bag')
        align('trial', scene_path('small'), '--bag', fresh, '--sample', '0.1')
        self.assertEqual(types(fresh), types(GOLDEN))
        for topic in TOPICS:
            a, b = plain(read(fresh, topic)), plain(read(GOLDEN, topic))
            if topic == '/aligner/result':  # how many steps it took is the solver's affair
                counted = ('steps', 'rejected', 'rhs_evaluations', 'events', 'energy')
                a, b = ([[field for field in message if field[0] not in counted] for message in side] for side in (a, b))
            if topic == '/aligner/markers':  # the text has rounded numbers
                a, b = (list(picture(read(path, topic))) for path in (fresh, GOLDEN))
            self.assertIsNone(difference(a, b, 1e-5, topic))

    def test_replay_publishes_every_message(self):
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        listeners = {topic: self.subscribe(topic) for topic in TOPICS}
        # a busy machine takes its time to connect the listeners, and to send what was published last
        self.launch('replay.launch', 'bag:=' + GOLDEN, 'rate:=0.01', 'rviz:=false',
                    'wait_for_subscribers:=true', 'keep_alive:=true')
        for topic, listener in listeners.items():
            expected = read(GOLDEN, topic)
            arrived = listener.wait(lambda _: len(self.played(listener)) >= len(expected), 60.0)
            self.assertTrue(arrived, '%s: %d of %d' % (topic, len(self.played(listener)), len(expected)))
            played = self.played(listener)
            self.assertIsNone(difference(plain(played), plain(expected), 0.0, topic))
            if topic == '/aligner/state':
                self.assertEqual([m.header.stamp for m in played], [m.header.stamp for m in expected])

    @staticmethod
    def played(listener):
        """The messages that are not of the aligner that runs beside."""
        return [message for message in listener.messages if message._connection_header['callerid'] != '/recorded']

    def subscribe(self, topic):
        kinds = {'contacts': AlignerContacts, 'markers': MarkerArray, 'parameter_updates': Config, 'a1': WrenchStamped,
                 'a2': WrenchStamped, 'restarts': UInt32, 'result': AlignerResult, 'state': AlignerState, 'tf': TFMessage,
                 'tf_static': TFMessage}
        return Listener(topic, kinds[topic.split('/')[-1]])

    def recorder(self):
        """Process id of the recorder."""
        uri = rosgraph.Master('/test').lookupNode('/record_aligner')
        return xmlrpc.client.ServerProxy(uri).getPid('/test')[2]

    def test_killed_recorder_leaves_all_but_the_last_chunk(self):
        run = self.launch('trial.launch', 'scene:=' + scene_path('small'), 'rviz:=false', 'exit_when_done:=true',
                          'record:=' + self.path('killed.bag'), 'sample_interval:=0.005', 'time_scale:=0.005')
        states = self.subscribe('/aligner/state')
        self.assertTrue(states.wait_for(250), 'the trial runs')
        published = len(states.messages)
        os.kill(self.recorder(), signal.SIGKILL)
        self.assertIn('rosbag reindex', run.communicate(timeout=90.0)[0])
        part = self.path('killed.bag.active')
        self.assertFalse(os.path.exists(self.path('killed.bag')))
        with self.assertRaises(rosbag.ROSBagUnindexedException):
            rosbag.Bag(part)
        subprocess.check_call(['rosbag', 'reindex', part], stdout=subprocess.DEVNULL)

        kept = [state.tau for state in read(part, '/aligner/state')]
        self.assertEqual(kept, [0.005 * i for i in range(len(kept))], 'from the start, without a gap')
        with rosbag.Bag(part) as bag:
            size = sum(len(raw[1]) for _, raw, _ in bag.read_messages(raw=True))
        lost = published - len(kept)
        self.assertLess(lost * size / len(kept), 1.5 * CHUNK, 'lost %d samples of %d' % (lost, published))

    def test_full_disk_ends_the_recording_and_nothing_else(self):
        self.node = '/recorded'
        # a name space of mounts for the recorder, in which its disk is small
        inside = ['unshare'] + ([] if os.getuid() == 0 else ['--map-root-user']) + ['--mount', 'sh', '-c']
        disk = self.path('disk')
        os.mkdir(disk)
        mount = 'mount -t tmpfs -o size=160k tmpfs ' + disk
        tried = subprocess.run(inside + [mount], stderr=subprocess.PIPE, universal_newlines=True)
        if tried.returncode != 0:
            self.skipTest('no small disk can be mounted here: ' + tried.stderr.strip())

        def record(least_free):
            command = 'roslaunch vibratory_alignment record.launch bag:=%s/trial.bag name:=recorded least_free:=%s'
            return subprocess.Popen(inside + [' && '.join((mount, command % (disk, least_free), 'cp %s/* %s' %
                                                           (disk, self.directory)))],
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)

        self.assertIn('less than 1G is free on the disk', record('1G').communicate(timeout=90.0)[0])
        recorder = record('1k')
        deadline = time.time() + 15.0
        while not self.recorded() and time.time() < deadline:
            time.sleep(0.1)
        states = self.listen('state')
        # on a busy machine the recorder misses much of a trial: the disk is full after another
        deadline = time.time() + 60.0
        runs = 0
        while runs == 0 or recorder.poll() is None and time.time() < deadline:
            self.assertEqual(self.run_to_end(states).outcome, 'time_limit', 'the trial goes on')
            self.assertEqual(states.messages[-1].tau, 3.0)
            runs += 1
        output = recorder.communicate(timeout=90.0)[0]
        for words in ('/trial.bag: recording ended early', ' 0 kB are free', 'rosbag reindex'):
            self.assertIn(words, output)
        part = self.path('trial.bag.active')
        subprocess.check_call(['rosbag', 'reindex', part], stdout=subprocess.DEVNULL)
        self.assertGreater(len(read(part, '/recorded/state')), 10)

    def recorded(self):
        """True when the recorder listens to the node."""
        subscribers = rosgraph.Master('/test').getSystemState()[1]
        return any(topic == '/recorded/state' and nodes for topic, nodes in subscribers)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'bags', Bags)
