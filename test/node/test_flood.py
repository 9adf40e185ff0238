#!/usr/bin/env python3
"""Settings that come as fast as they can, from several programs at once."""
import threading

import rospy
import rostest
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure

from aligner_test_case import AlignerTestCase


class Flood(AlignerTestCase):

    def test_trial_ends_and_has_no_gap(self):
        rospy.wait_for_service('/aligner/set_parameters', 15.0)
        states = self.listen('state')
        done = threading.Event()
        sent = [0, 0, 0]

        def send(number):
            service = rospy.ServiceProxy('/aligner/set_parameters', Reconfigure, persistent=True)
            while not done.is_set():
                sent[number] += 1
                service(Config(doubles=[DoubleParameter('amplitude', 1.0 + 0.001 * (sent[number] % 7))]))

        threads = [threading.Thread(target=send, args=(number,)) for number in range(len(sent))]
        for thread in threads:
            thread.start()
        try:
            result = self.run_to_end(states)
        finally:
            done.set()
            for thread in threads:
                thread.join()
        self.assertEqual(result.outcome, 'time_limit')
        self.assertGreater(sum(sent), 20)
        instants = [state.tau for state in states.messages]
        for earlier, later in zip(instants, instants[1:]):
            self.assertAlmostEqual(later - earlier, 0.01, places=9)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'flood', Flood)
