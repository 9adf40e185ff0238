#!/usr/bin/env python3
"""Work-precision figure from the table of `align accuracy --csv`: CPU time over error, one line per solver."""

import argparse
import csv
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import interrupts  # noqa: E402, F401  (before what takes its time)
from drawing import SOLVER_STYLES, plt, set_title  # noqa: E402

SOLID = {"markersize": 4.5, "linewidth": 1.2, "zorder": 3}
# `auto` often is `event` or `implicit` to the bit: both stay to be seen
HOLLOW = {"markersize": 8.5, "linewidth": 1.2, "linestyle": "--", "markerfacecolor": "none", "zorder": 2}


def read_lines(path):
    """Maps solver to its (error, microseconds), coarse to fine; and the error below which nothing is told."""
    lines, floor = {}, 0.0
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            floor = float(row["reference_agreement"])
            if row["pose_error"]:
                point = (float(row["pose_error"]), 1e6 * float(row["cpu_seconds"]))
                lines.setdefault(row["solver"], []).append(point)
    return lines, floor


def draw(lines, floor, title, target, kind):
    figure, axes = plt.subplots(figsize=(6.4, 5.0), constrained_layout=True)
    # within the shaded part: how far below what the reference knows is not known either
    least_drawn = 0.3 * floor if floor > 0.0 else 1e-17
    for solver, points in lines.items():
        colour, mark = SOLVER_STYLES.get(solver, ("#000000", "."))
        style = HOLLOW if solver == "auto" else SOLID
        errors, times = zip(*points)
        drawn = [max(error, least_drawn) for error in errors]
        axes.loglog(drawn, times, color=colour, marker=mark, label=solver, **style)
    least, most = axes.get_xlim()
    if floor > least:
        axes.axvspan(least, min(floor, most), color="0.93", zorder=0, label="less than the reference knows")
    axes.set_xlim(most, least)  # error falls from left to right
    axes.set_xlabel("error of the pose at the end (dimensionless)")
    axes.set_ylabel("CPU time of a trial [µs]")
    set_title(figure, title)
    axes.grid(True, which="major", color="0.88", linewidth=0.6)
    # below the axes, where it covers no line
    axes.legend(frameon=False, ncol=3, fontsize=9, loc="upper center", bbox_to_anchor=(0.5, -0.13))
    figure.savefig(target, dpi=160, format=kind, metadata={"Date": None} if kind == "svg" else None)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table", help="CSV file of `align accuracy`")
    parser.add_argument("picture", help="file to write")
    parser.add_argument("--format", default="png", choices=("png", "svg", "pdf"))
    parser.add_argument("--title", default="", help="title of the figure")
    arguments = parser.parse_args()
    try:
        lines, floor = read_lines(arguments.table)
    except OSError as error:
        sys.exit("plot_accuracy.py: %s: %s" % (arguments.table, error.strerror or error))
    except (KeyError, TypeError, ValueError) as error:
        sys.exit("plot_accuracy.py: %s: is no table of `align accuracy --csv` (%s)" % (arguments.table, error))
    if not lines:
        sys.exit(arguments.table + ": holds no run")
    try:
        draw(lines, floor, arguments.title, arguments.picture, arguments.format)
    except OSError as error:
        sys.exit("plot_accuracy.py: %s: cannot be written: %s" % (arguments.picture, error.strerror or error))


if __name__ == "__main__":
    main()
