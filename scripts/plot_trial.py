#!/usr/bin/env python3
"""Draws a trial as the paper draws its Fig. 2: position, velocities, tilt and the reactions at the slot's edges over time.

usage: plot_trial.py TRIAL PICTURE [--format FORMAT] [--node NAME] [--si] [--title TEXT]

`align plot` calls it and describes the options. Exit status: 0 drawn, 1 it failed while drawing, 2 TRIAL cannot be drawn.
"""

import argparse
import csv
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import interrupts  # noqa: E402, F401  (before what takes its time)

COLUMNS = ("t", "x", "y", "phi", "vx", "vy", "n1", "n2")
STATE_TYPE = "vibratory_alignment/AlignerState"
SHOWN_SI = {"t": (1e3, "ms"), "x": (1e3, "mm"), "y": (1e3, "mm"), "vx": (1e3, "mm/s"), "vy": (1e3, "mm/s"),
            "phi": (1e3, "mrad"), "n1": (1.0, "N"), "n2": (1.0, "N")}


class BadTrial(Exception):
    """TRIAL cannot be drawn; the words say why."""


def read_csv(path):
    """Columns of what `align trial --csv` writes, and no words about the outcome."""
    motion = {column: [] for column in COLUMNS}
    try:
        with open(path, newline="") as file:
            rows = csv.DictReader(file)
            present = rows.fieldnames or []
            for column in COLUMNS:
                if column not in present:
                    raise BadTrial("has no column %s; there must be %s" % (column, ", ".join(COLUMNS)))
            for row in rows:
                for column in COLUMNS:
                    motion[column].append(number(row[column], "line %d: %s" % (rows.line_num, column)))
    except (UnicodeDecodeError, csv.Error) as error:
        raise BadTrial("is no CSV file, and a bag is named *.bag (%s)" % error)
    return motion, ""


def number(text, place):
    try:
        value = float(text)
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise BadTrial("%s: %s: must be a number" % (place, "nothing is there" if text is None else text))
    return value


def read_bag(path, node, si):
    """Columns of the last run in a bag, dimensionless or in SI, and words about its outcome."""
    try:
        import rosbag
    except ImportError as error:
        sys.exit("a bag needs rosbag (apt-get install python3-rosbag), which %s does not find: %s"
                 % (sys.executable, error))
    try:
        with rosbag.Bag(path) as bag:
            return read_last_run(bag, find_node(bag, node), si)
    except rosbag.bag.ROSBagUnindexedException:
        raise BadTrial("the bag was not closed: `rosbag reindex %s` makes it readable" % path)
    except rosbag.ROSBagException as error:
        raise BadTrial("is not a whole bag: %s" % error)


def find_node(bag, wanted):
    """Name of the aligner whose trial is drawn."""
    topics = bag.get_type_and_topic_info().topics
    nodes = sorted(topic[: -len("/state")] for topic, info in topics.items()
                   if info.msg_type == STATE_TYPE and topic.endswith("/state"))
    if not nodes:
        raise BadTrial("has no topic state of an aligner (%s); its topics: %s"
                       % (STATE_TYPE, ", ".join(sorted(topics)) or "none"))
    if wanted:
        name = "/" + wanted.strip("/")
        if name not in nodes:
            raise BadTrial("--node %s: has no topic %s/state; its aligners: %s" % (wanted, name, ", ".join(nodes)))
        return name
    if len(nodes) > 1:
        raise BadTrial("has several aligners; choose one with --node: %s" % ", ".join(nodes))
    return nodes[0]


def read_last_run(bag, node, si):
    motion = {column: [] for column in COLUMNS}
    state, result = None, None  # the last ones
    for topic, message, _ in bag.read_messages(topics=[node + "/state", node + "/result"]):
        if topic.endswith("/result"):
            # it is latched: who joins a trial gets that of the one before, which is older than the states
            if not state or message.header.stamp >= state.header.stamp:
                result = message
            continue
        if state and message.header.stamp == state.header.stamp:
            continue  # the last one, for a newcomer
        if si and not message.has_scales:
            raise BadTrial("--si: the scene %s has no scales, so its numbers have no SI units" % message.scene)
        if state and message.tau <= state.tau:  # ~reset, ~load_scene, a goal: another run begins
            motion, result = {column: [] for column in COLUMNS}, None
        if result and message.header.stamp > result.header.stamp:
            result = None
        state = message
        pose = state.si if si else state.dimensionless
        forces = [force if si else force / state.force_scale for force in state.peak_force[:2]]
        values = (state.time if si else state.tau, pose.x, pose.y, pose.phi, pose.vx, pose.vy, *forces)
        for column, value in zip(COLUMNS, values):
            motion[column].append(value)
    return motion, "%s: %s" % (result.scene, outcome_text(result)) if result else ""


def outcome_text(result):
    """Words for the outcome of an AlignerResult."""
    text = result.outcome.replace("_", " ")
    if result.duration != result.duration or not result.time:  # NaN: it did not align
        return text
    if result.outcome != "aligned":  # the trial went on
        text += "; aligned"
    text += " after τ = %.4g" % (result.duration * result.tau / result.time)
    return text + (" (%.4g ms)" % (1e3 * result.duration) if result.has_scales else "")


def draw(motion, options, title, from_bag):
    # What is refused is refused before the seconds that matplotlib takes to load.
    from drawing import AT_SAMPLES, FIG2_PANELS, draw_motion, set_style, set_title

    # A CSV file does not tell whether its time is dimensionless.
    time, note = (r"$\tau$", "largest since the message before") if from_bag else ("$t$", AT_SAMPLES)
    units = {}
    if options.si:
        for column, (factor, unit) in SHOWN_SI.items():
            motion[column] = [factor * value for value in motion[column]]
            units[column] = unit
        time = "$t$ [%s]" % units["t"]
    set_style()
    sheet = draw_motion(FIG2_PANELS, motion, note, time, units)
    set_title(sheet, title)
    kind = options.format or os.path.splitext(options.picture)[1][1:]
    sheet.savefig(options.picture, dpi=150, format=kind, metadata={"Date": None} if kind == "svg" else None)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     usage=argparse.SUPPRESS)
    parser.add_argument("trial")
    parser.add_argument("picture")
    parser.add_argument("--format")
    parser.add_argument("--node", default="")
    parser.add_argument("--si", action="store_true")
    parser.add_argument("--title", default="")
    options = parser.parse_args()
    from_bag = options.trial.endswith(".bag")
    try:
        motion, outcome = read_bag(options.trial, options.node, options.si) if from_bag else read_csv(options.trial)
        if not motion["t"]:
            raise BadTrial("there is no motion in it")
    except (BadTrial, OSError) as error:
        print("align: %s: %s" % (options.trial, error), file=sys.stderr)
        sys.exit(2)
    try:
        draw(motion, options, options.title or outcome or os.path.basename(options.trial), from_bag)
    except OSError as error:
        sys.exit("align: %s: cannot be written: %s" % (options.picture, error.strerror or error))


if __name__ == "__main__":
    main()
