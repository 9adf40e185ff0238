"""Bags as the tests compare them: messages without what differs from run to run, and the picture that rviz shows."""

import math

import rosbag

# Stamps and counters of messages, and what is measured anew each time.
PASSING = ('stamp', 'seq', 'cpu_seconds')


def read(path, topic):
    """Messages of a topic, in the order of the bag."""
    with rosbag.Bag(path) as bag:
        return [message for _, message, _ in bag.read_messages(topics=[topic])]


def types(path):
    """Maps each topic to type and checksum."""
    with rosbag.Bag(path) as bag:
        info = bag.get_type_and_topic_info()
        return {topic: (entry.msg_type, info.msg_types[entry.msg_type]) for topic, entry in info.topics.items()}


def plain(value):
    """The value of a message or field as lists, tuples and numbers, without what passes."""
    if hasattr(value, '__slots__') and hasattr(value, '_type'):
        return [(name, plain(getattr(value, name))) for name in value.__slots__ if name not in PASSING]
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return value


def difference(a, b, tolerance, place=''):
    """Words about the first difference of two plain values; None if all numbers agree to the tolerance.

    relative to the number, or to 1 (of its unit) if that is smaller
    """
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        if len(a) != len(b):
            return '%s: %d and %d elements' % (place, len(a), len(b))
        for i, (one, other) in enumerate(zip(a, b)):
            name = a[i][0] if isinstance(one, tuple) else i
            found = difference(one, other, tolerance, '%s/%s' % (place, name))
            if found:
                return found
        return None
    if isinstance(a, float) or isinstance(b, float):
        same = a == b or (math.isnan(a) and math.isnan(b)) or abs(a - b) <= tolerance * max(1.0, abs(a), abs(b))
    else:
        same = a == b
    return None if same else '%s: %r and %r' % (place, a, b)


def picture(messages):
    """What rviz shows after these marker arrays: maps (namespace, id) to the marker."""
    shown = {}
    for array in messages:
        for marker in array.markers:
            if marker.action == marker.DELETEALL:
                shown.clear()
            elif marker.action == marker.DELETE:
                shown.pop((marker.ns, marker.id), None)
            else:
                shown[marker.ns, marker.id] = plain(marker)
    return shown
