#!/usr/bin/env python3
"""Draws a trial: position, tilt and the forces at the slot's edges over time, as a PNG, PDF or SVG file.

usage: plot_trial.py TRIAL PICTURE [--title TEXT]

TRIAL is a CSV file of `align trial --csv`, or a bag: one that `align trial --bag` wrote, or a recording of
aligner_node. A CSV file is drawn in its own units, a bag in dimensionless numbers. In a bag's picture each force is
the largest one since the message before.
"""

import argparse
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

BLUE, ORANGE, GREY = "#1f5fa8", "#d9730d", "#666666"
STATE_SUFFIX = "/state"
RESULT_SUFFIX = "/result"


class Trial:
    """Columns over time, and a line that says what came out of it."""

    def __init__(self):
        self.t, self.x, self.y, self.phi, self.n1, self.n2 = [], [], [], [], [], []
        self.forces_are_peaks = False
        self.title = ""


def read_csv(path):
    """Reads what `align trial --csv` writes. Raises KeyError or ValueError for other files."""
    trial = Trial()
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            for key in ("t", "x", "y", "phi", "n1", "n2"):
                getattr(trial, key).append(float(row[key]))
    return trial


def read_bag(path):
    """Reads the topics state and result of the first aligner in the bag."""
    import rosbag

    trial = Trial()
    trial.forces_are_peaks = True
    with rosbag.Bag(path) as bag:
        for topic, message, _ in bag.read_messages():
            if topic.endswith(STATE_SUFFIX):
                state = message.dimensionless
                values = (message.tau, state.x, state.y, state.phi) + tuple(
                    force / message.force_scale for force in message.peak_force[:2]
                )
                for key, value in zip(("t", "x", "y", "phi", "n1", "n2"), values):
                    getattr(trial, key).append(value)
            elif topic.endswith(RESULT_SUFFIX):
                trial.title = "%s: %s" % (message.scene, outcome_text(message))
    return trial


def outcome_text(result):
    """Words for the outcome of an AlignerResult."""
    text = result.outcome.replace("_", " ")
    if result.duration != result.duration or not result.time:  # NaN: it did not align
        return text
    text += r" after $\tau$ = %.4g" % (result.duration * result.tau / result.time)
    return text + (" (%.4g ms)" % (1e3 * result.duration) if result.has_scales else "")


def draw(trial, path):
    """Writes the picture; the suffix of the path decides on its format."""
    plt.rcParams.update({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(
        4, 1, sharex=True, figsize=(9, 8), gridspec_kw={"height_ratios": [1, 1, 1, 1.2]}, constrained_layout=True
    )
    figure.suptitle(trial.title, fontsize=13)
    for axis, values, label in zip(axes, (trial.x, trial.y, trial.phi), ("x", "y", r"tilt $\varphi$ [rad]")):
        axis.plot(trial.t, values, color=BLUE, linewidth=1.2)
        axis.set_ylabel(label)
    axes[0].axhline(0.0, color=GREY, linewidth=0.8, linestyle="--")
    axes[0].annotate("axis of the slot", (0.995, 0.0), xycoords=("axes fraction", "data"), xytext=(0, 3),
                     textcoords="offset points", color=GREY, ha="right", fontsize=8)
    forces = axes[3]
    curves = ((trial.n1, BLUE, "$n_1$, edge a1 (right)"), (trial.n2, ORANGE, "$n_2$, edge a2 (left)"))
    for values, color, label in curves:
        forces.fill_between(trial.t, values, color=color, alpha=0.25, linewidth=0)
        forces.plot(trial.t, values, color=color, linewidth=0.9, label=label)
    forces.set_ylim(bottom=0.0)
    forces.set_ylabel("normal force" + (",\nlargest since last message" if trial.forces_are_peaks else ""))
    forces.legend(frameon=False, ncol=2, loc="upper right")
    forces.set_xlabel(r"time $\tau$" if trial.forces_are_peaks else "time t")
    for axis in axes:
        axis.grid(True, color="#dddddd", linewidth=0.6)
        axis.margins(x=0.0)
    figure.align_ylabels(axes)
    figure.savefig(path, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     usage=argparse.SUPPRESS)
    parser.add_argument("trial")
    parser.add_argument("picture")
    parser.add_argument("--title")
    options = parser.parse_args()
    try:
        trial = read_bag(options.trial) if options.trial.endswith(".bag") else read_csv(options.trial)
        if not trial.t:
            raise ValueError("there is no trial in it")
        if options.title:
            trial.title = options.title
        draw(trial, options.picture)
    except KeyError as error:
        sys.exit("plot_trial.py: %s: has no column %s" % (options.trial, error))
    except Exception as error:
        sys.exit("plot_trial.py: %s: %s" % (options.trial, error))


if __name__ == "__main__":
    main()
