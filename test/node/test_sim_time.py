#!/usr/bin/env python3
"""Stamps while ROS time stands still at 0, and under the clock of somebody else."""
import itertools
import subprocess
import threading
import time

import rospy
import rostest
import tf2_ros
from rosgraph_msgs.msg import Clock

from aligner_test_case import AlignerTestCase, Listener, program, scene_path
from vibratory_alignment.msg import AlignerState


class PeriodicThread(threading.Thread):
    """Does something again and again, with so many seconds of wall time in between, until it is stopped."""

    def __init__(self, interval, action):
        super().__init__(daemon=True)
        self.interval, self.action, self.stopped = interval, action, threading.Event()
        self.start()

    def run(self):
        while not self.stopped.wait(self.interval):
            self.action()

    def stop(self):
        self.stopped.set()
        self.join()


class SimTime(AlignerTestCase):

    def assert_rising(self, stamps):
        self.assertGreater(stamps[0].to_nsec(), 0)
        for earlier, later in zip(stamps, stamps[1:]):
            self.assertLess(earlier, later)

    def test_0_a_clock_that_never_comes_is_missed_in_the_log(self):
        process = subprocess.Popen((program('aligner_node'), '__name:=other', '_scene_file:=' + scene_path('small'),
                                    '_autostart:=false'), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   universal_newlines=True)
        time.sleep(8.0)
        process.terminate()
        self.assertEqual(process.communicate(timeout=10.0)[0].count('rosparam delete /use_sim_time'), 1)

    def test_1_stamps_rise_from_above_zero_without_a_clock(self):
        states = self.listen('state')
        self.run_to_end(states)
        stamps = [state.header.stamp for state in states.messages]
        self.assertGreater(len(stamps), 100)
        self.assert_rising(stamps)

    def tell(self, seconds):
        """The other's clock; everybody has it when this returns."""
        self.publisher.publish(Clock(rospy.Time.from_sec(seconds)))
        time.sleep(0.15)

    def step(self):
        """Stamps of five samples."""
        count = len(self.states.messages)
        self.assertTrue(self.step_by(samples=5).success)
        self.assertTrue(self.states.wait_for(count + 5))
        return [state.header.stamp for state in self.states.messages[count:]]

    def test_2_stamps_and_buffers_follow_the_clock_of_somebody_else(self):
        self.publisher = rospy.Publisher('/clock', Clock, queue_size=10)
        deadline = time.time() + 10.0
        while self.publisher.get_num_connections() < 2 and time.time() < deadline:  # this node and the aligner
            time.sleep(0.02)
        self.tell(50.0)
        buffer = tf2_ros.Buffer(rospy.Duration(10.0))
        tf2_ros.TransformListener(buffer)
        self.states = self.listen('state')
        self.reset(self.states)

        # the clock stands, jumps far ahead, far back, a little back
        markers = self.listen('markers')
        before = 0.0
        for instant in (100.0, 100.0, 5000.0, 20.0, 20.0, 19.9, 0.5):
            pictures = len(markers.messages)
            self.tell(instant)
            if instant < before:  # buffers are empty, and rviz has cleared its picture: both are told anew
                self.assertTrue(markers.wait_for(pictures + 1, 2.0))
                time.sleep(0.2)
                found = buffer.lookup_transform('slot', 'part', rospy.Time(0))
                self.assertAlmostEqual(found.header.stamp.to_sec(), instant, delta=1e-6)
            before = instant
            stamps = self.step()
            self.assert_rising(stamps)
            self.assertAlmostEqual(stamps[-1].to_sec(), instant, delta=1e-6)
            time.sleep(0.2)
            self.assertTrue(buffer.can_transform('world', 'edge_a1', rospy.Time(0)))
            found = buffer.lookup_transform('slot', 'part', rospy.Time(0))
            self.assertEqual(found.header.stamp, stamps[-1], 'no transform of before the jump')
            self.assertEqual(found.transform.translation.x, self.states.messages[-1].si.x)

    def test_3_a_clock_that_stands_stops_neither_trial_nor_node(self):
        self.assertEqual(self.run_to_end().tau, 3.0)

    def test_4_stamps_begin_with_a_clock_that_runs_already(self):
        publisher = rospy.Publisher('/clock', Clock, queue_size=10)
        instants = itertools.count(1000)
        timer = PeriodicThread(0.4, lambda: publisher.publish(Clock(rospy.Time(next(instants)))))
        self.addCleanup(timer.stop)
        states = Listener('/late/state', AlignerState)
        process = subprocess.Popen((program('aligner_node'), '__name:=late', '_scene_file:=' + scene_path('small'),
                                    '_time_scale:=0.01'), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        self.assertTrue(states.wait_for(5))
        self.assertGreaterEqual(min(state.header.stamp.to_sec() for state in states.messages), 1000.0)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'sim_time', SimTime)
