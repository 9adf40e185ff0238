#!/usr/bin/env python3
"""A small assembly cell: aligns several parts, one after the other, each with settings of its own, and reports.

A client of the action ~align of aligner_node, as a sequencer of one's own would be. Parameters:
  ~aligner  name of the aligner (default: aligner)
  ~parts    list of maps: `part`, the name for the report, and any fields of the action's goal (action/Align.action)
  ~patience wall time for one part [s] (default: 120)
  ~stay     true: does not end with the last part, so that the report can be had later (default: false)
Topic ~report (std_msgs/String, latched): a list of results as YAML, when the last part is done.
The fields of all parts are checked before the first one is aligned; what they name, like a scene, by the aligner.
Interrupted, it cancels the goal that is under way.
Exit status: 0 every part is in its slot, 1 some are not, the aligner does not answer, or a part cannot be asked for.
"""
import math
import sys
import time
from io import BytesIO

import actionlib
import actionlib.action_client
import genpy
import rospy
import yaml
from actionlib_msgs.msg import GoalStatus
from std_msgs.msg import String

from vibratory_alignment.msg import AlignAction, AlignGoal

UNDER_WAY = (GoalStatus.PENDING, GoalStatus.ACTIVE)
STATES = {value: name.lower() for name, value in vars(GoalStatus).items() if name.isupper()}


def name_of(part):
    return part.get('part', part.get('scene', 'part'))


def goal_of(part):
    """The goal with the fields that a part gives. Raises ValueError for a field that is none, or a value of it."""
    goal = AlignGoal()
    for key, value in part.items():
        if key == 'part':
            continue
        if key not in AlignGoal.__slots__:
            raise ValueError('%s: no field of the goal; these are: %s' % (key, ', '.join(AlignGoal.__slots__)))
        try:
            # PyYAML takes 1e-3 for text
            setattr(goal, key, float(value) if isinstance(value, str) and key != 'scene' else value)
            goal.serialize(BytesIO())
        except (ValueError, genpy.SerializationError) as error:
            raise ValueError('%s: %r: %s' % (key, value, error)) from None
    return goal


def goals_of(parts):
    """The goals of all parts, None if one is impossible: what is wrong with each has been said then."""
    if not (isinstance(parts, list) and parts and all(isinstance(part, dict) for part in parts)):
        rospy.logfatal('%s: must be a list of maps, one for each part: %r', rospy.resolve_name('~parts'), parts)
        return None
    goals, faults = [], []
    for number, part in enumerate(parts):
        try:
            goals.append(goal_of(part))
        except ValueError as error:
            faults.append('%s[%d] (%s): %s' % (rospy.resolve_name('~parts'), number, name_of(part), error))
    for fault in faults:
        rospy.logfatal(fault)
    return None if faults else goals


def wait(condition, seconds):
    """Waits in wall time, which passes also while simulated time stands still."""
    end = time.time() + seconds
    while not condition() and time.time() < end and not rospy.is_shutdown():
        time.sleep(0.02)
    return condition()


def cancel(client):
    """While ROS shuts down: else the aligner would go on with the goal, and take no other one."""
    if client.gh is None or client.get_state() not in UNDER_WAY:
        return
    client.cancel_goal()
    end = time.time() + 2.0
    while client.get_state() in UNDER_WAY and time.time() < end:
        time.sleep(0.02)


def align(client, name, goal, patience):
    """Has one part aligned; what became of it, for the report. Raises ROSInterruptException when ROS shuts down."""
    reported = [0]

    def on_feedback(feedback):
        tenths = int(10.0 * feedback.progress)
        if tenths > reported[0]:
            reported[0] = tenths
            rospy.loginfo('%s: %3.0f %%, %.3g mm from the axis of the slot', name, 100.0 * feedback.progress,
                          1e3 * feedback.misalignment)

    client.send_goal(goal, feedback_cb=on_feedback)
    is_done = wait(lambda: client.get_state() not in UNDER_WAY, patience)
    if rospy.is_shutdown():
        raise rospy.ROSInterruptException
    if not is_done:
        rospy.logwarn('%s: takes too long: cancelled', name)
        client.cancel_goal()
    wait(lambda: client.get_result() is not None, 5.0)
    report = {'part': name, 'state': STATES[client.get_state()], 'text': client.get_goal_status_text()}
    result = client.get_result()
    if result is not None and result.outcome:
        aligned_ms = None if math.isnan(result.duration) else 1e3 * result.duration
        report.update(outcome=result.outcome, time_ms=1e3 * result.time, aligned_ms=aligned_ms,
                      peak_force=max(result.peak_force), impacts=sum(result.impacts),
                      force_limit_exceeded=result.force_limit_exceeded, energy_residual=result.energy_residual)
    return report


def main():
    rospy.init_node('cell')
    server = rospy.resolve_name(rospy.get_param('~aligner', 'aligner')) + '/align'
    parts, patience = rospy.get_param('~parts', None), rospy.get_param('~patience', 120.0)
    if isinstance(patience, bool) or not isinstance(patience, (int, float)) or not patience > 0.0:
        rospy.logfatal('%s: must be a number > 0 [s]: %r', rospy.resolve_name('~patience'), patience)
        return 1
    goals = goals_of(parts)
    if goals is None:
        return 1
    # goals are told apart by node name, this counter and ROS time, which a clock of the aligner's own sets back: one that
    # the aligner has had already it would not answer
    actionlib.action_client.g_goal_id = time.time_ns()
    client = actionlib.SimpleActionClient(server, AlignAction)
    publisher = rospy.Publisher('~report', String, queue_size=1, latch=True)
    if not wait(lambda: client.action_client.wait_for_server(rospy.Duration(0.001)), 30.0):
        rospy.logfatal('%s does not answer', server)
        return 1
    rospy.on_shutdown(lambda: cancel(client))
    try:
        reports = [align(client, name_of(part), goal, patience) for part, goal in zip(parts, goals)]
    except rospy.ROSInterruptException:
        rospy.logwarn('interrupted: the part under way is given up, those after it are not aligned')
        return 1
    for report in reports:
        if 'outcome' in report:
            aligned = 'not aligned, ' if report['aligned_ms'] is None else 'aligned after %(aligned_ms).3g ms, '
            rospy.loginfo(('%(part)s: %(outcome)s after %(time_ms).3g ms, ' +
                           ('' if report['outcome'] == 'aligned' else aligned) +
                           '%(impacts)d impacts, peak %(peak_force).3g N') % report)
        else:
            rospy.logerr('%(part)s: %(state)s: %(text)s', report)
    publisher.publish(yaml.safe_dump(reports))
    wait(lambda: False, math.inf if rospy.get_param('~stay', False) else 1.0)  # for those who want the report
    return 0 if all(report['state'] == 'succeeded' for report in reports) else 1


if __name__ == '__main__':
    sys.exit(main())
