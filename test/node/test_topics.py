#!/usr/bin/env python3
"""Frames, stamps and rates of the topics."""
import math

import rostest

from aligner_test_case import AlignerTestCase

FRAMES = {'state': 'slot', 'contacts': 'slot', 'reaction/a1': 'edge_a1', 'reaction/a2': 'edge_a2'}


class Topics(AlignerTestCase):

    def test_frames_stamps_and_rates(self):
        listeners = {topic: self.listen(topic) for topic in FRAMES}
        markers = self.listen('markers')
        result = self.run_to_end(markers, *listeners.values())
        self.assertEqual(result.header.frame_id, 'slot')

        stamps = {}
        for topic, listener in listeners.items():
            self.assertGreater(len(listener.messages), 100, topic)
            self.assertEqual({message.header.frame_id for message in listener.messages}, {FRAMES[topic]})
            numbers = [message.header.seq for message in listener.messages]
            self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))), topic + ': one after the other')
            stamps[topic] = [message.header.stamp for message in listener.messages]
            for earlier, later in zip(stamps[topic], stamps[topic][1:]):
                self.assertLess(earlier, later, topic + ': stamps must rise')
            for stamp, arrival in zip(stamps[topic], listener.arrivals):
                self.assertAlmostEqual(stamp.to_sec(), arrival, delta=0.5)
        for topic in FRAMES:
            self.assertEqual(stamps[topic], stamps['state'], 'one instant, one stamp')

        # 0.01 of 5 ms at a time scale of 0.01: 200 messages a second
        last = stamps['state'][-200:]
        self.assertAlmostEqual((last[-1] - last[0]).to_sec() / (len(last) - 1), 0.005, delta=0.001)

        frames = {marker.header.frame_id for message in markers.messages for marker in message.markers}
        self.assertEqual(frames, {'slot'})
        names = {marker.ns for message in markers.messages for marker in message.markers}
        self.assertLessEqual({'base', 'part', 'trace', 'contact', 'reaction', 'peak', 'text'}, names)

    def test_contacts_agree_with_reactions(self):
        contacts, reactions = self.listen('contacts'), self.listen('reaction/a1')
        self.run_to_end(contacts, reactions)
        compared = 0
        forces = {message.header.stamp: message.wrench.force for message in reactions.messages}
        for message in contacts.messages:
            for contact in message.states:
                self.assertIn(contact.info, ('a1', 'a2', 'b1', 'b2'))
                if contact.info != 'a1' or not contact.wrenches:
                    continue
                force = forces[message.header.stamp]
                self.assertEqual((force.x, force.z), (contact.total_wrench.force.x, contact.total_wrench.force.z))
                self.assertGreater(contact.depths[0], 0.0)
                normal = contact.contact_normals[0]
                self.assertAlmostEqual(math.hypot(normal.x, normal.z), 1.0, places=12)
                self.assertGreater(normal.z, 0.0, 'the base pushes up')
                compared += 1
        self.assertGreater(compared, 5)


if __name__ == '__main__':
    rostest.rosrun('vibratory_alignment', 'topics', Topics)
