#!/usr/bin/env python3
"""Draws the figures of `align reproduce` in the axes of the paper, as SVG and PNG.

usage: plot_figures.py FOLDER

FOLDER holds figures.json, which says what to draw, and a CSV file for each figure, as `align reproduce` writes them.
"""

import argparse
import collections
import csv
import json
import os
import pathlib
import sys
import textwrap

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import interrupts  # noqa: E402  (before what takes its time)
from drawing import AT_SAMPLES, draw_motion, plt, set_style, set_title, tidy  # noqa: E402
from matplotlib.colors import ListedColormap  # noqa: E402
from matplotlib.transforms import ScaledTranslation  # noqa: E402

# Marks as well as colours tell the curves apart, also in grey and for those who see colours otherwise (Okabe and Ito).
STYLES = (("#0072B2", "o"), ("#D55E00", "s"), ("#009E73", "^"), ("#CC79A7", "D"), ("#E69F00", "v"), ("#56B4E9", "X"))

MARK_SIZE = 4.5  # points

# The paper's symbols.
SYMBOLS = {
    "duration": r"alignment duration $\tau$",
    "gripper.pressing_force": r"$f_0$",
    "gripper.stiffness.x": r"$k_x$",
    "gripper.stiffness.phi": r"$k_\varphi$",
    "excitation.frequency": r"$\nu$",
    "excitation.amplitude": r"$A$",
    "initial.x": r"$x_C|_{\tau=0}$",
    "slot.clearance": r"$\delta$",
    "aligned && nonimpact_time <= 0.2 * duration": "impact mode prevails",
}


def symbol(formula):
    """Words for a formula, or the formula itself, in as many lines as it takes."""
    return SYMBOLS.get(formula) or textwrap.fill(formula, 50)


def read_rows(path):
    """Rows of a CSV file as dictionaries of numbers; what is empty is NaN. Raises ValueError where there is none."""
    rows = []
    with open(path, newline="") as file:
        reader = csv.DictReader(file, restval="missing")
        for row in reader:
            try:
                rows.append({key: float(text or "nan") for key, text in row.items()})
            except (TypeError, ValueError):
                raise ValueError("%s: line %d: must be %d numbers"
                                 % (path.name, reader.line_num, len(reader.fieldnames)))
    if not rows:
        raise ValueError("%s: holds no row" % path.name)
    return rows


def read_figures(path):
    """What figures.json says of each figure. Raises ValueError where it says something else."""
    figures = json.loads(path.read_text())
    if not isinstance(figures, list) or not all(isinstance(figure, dict) for figure in figures):
        raise ValueError("%s: must be a list of figures" % path.name)
    return figures


def draw_trial(figure, rows):
    return draw_motion(figure["panels"], {column: [row[column] for row in rows] for column in rows[0]}, AT_SAMPLES)


def beside(axes, number, count):
    """Where curve `number` of `count` is drawn, so that no bar covers another: all within the width of a mark, which is
    less than reads as another value."""
    shift = MARK_SIZE * (number / (count - 1) - 0.5) if count > 1 else 0.0
    return axes.transData + ScaledTranslation(shift / 72.0, 0.0, axes.figure.dpi_scale_trans)


def draw_curves(figure, rows):
    """Medians or means with quartiles; hollow where the mark does not hold; nothing where too few samples align."""
    curves = collections.OrderedDict()
    for row in rows:
        curves.setdefault(tuple(row[key] for key in figure["each"]), []).append(row)
    sheet, axes = plt.subplots(figsize=(6.0, 4.0), constrained_layout=True)
    along = figure["along"]
    for number, (key, points) in enumerate(curves.items()):
        colour, mark = STYLES[number % len(STYLES)]
        place = beside(axes, number, len(curves))
        at = [row[along] for row in points]
        value = [row["median"] for row in points]
        label = ", ".join("%s = %g" % (symbol(name), part) for name, part in zip(figure["each"], key))
        if all(v != v for v in value):
            label = (label + " (too few values)").strip()
        axes.plot(at, value, color=colour, linewidth=1.0, label=label, marker=mark, markersize=MARK_SIZE,
                  markerfacecolor="white", zorder=3, transform=place)
        marked = [(a, v) for a, v, row in zip(at, value, points) if row["mark"] >= figure["share"]]
        if marked:
            axes.plot(*zip(*marked), color=colour, linestyle="none", marker=mark, markersize=MARK_SIZE, zorder=4,
                      transform=place)
        present = [(a, v, v - row["low"], row["high"] - v) for a, v, row in zip(at, value, points) if v == v]
        if present:
            places, middles, below, above = zip(*present)
            axes.errorbar(places, middles, yerr=(below, above), color=colour, linestyle="none", elinewidth=0.8,
                          capsize=1.8, zorder=2, transform=place)
    axes.set_xlabel(symbol(along))
    axes.set_ylabel(symbol(figure["of"]))
    if axes.dataLim.ymin > 0.0:
        axes.set_ylim(bottom=0.0)
    axes.set_title(textwrap.fill(what_is_drawn(figure), 85), fontsize=9)
    tidy(axes)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(frameon=False, fontsize=9, ncol=len(curves) if len(curves) < 4 else 2)
    return sheet


def what_is_drawn(figure):
    """The words below the title of curves."""
    words = "%ss and quartiles" % figure["point"]
    if "mark" in figure:
        words += "; filled: %s in at least %g %%" % (symbol(figure["mark"]), 100 * figure["share"])
    return words


def edges(values):
    """Borders of the cells around the points of an axis."""
    inner = [0.5 * (a + b) for a, b in zip(values, values[1:])]
    return [2 * values[0] - inner[0]] + inner + [2 * values[-1] - inner[-1]]


def draw_region(figure, rows):
    """The plane of two values: hatched where alignment is not reliable, as in the paper."""
    x, y = figure["x"], figure["y"]
    xs, ys = sorted({row[x] for row in rows}), sorted({row[y] for row in rows})
    share = {(row[x], row[y]): row["share"] for row in rows}
    field = [[share[a, b] for a in xs] for b in ys]
    sheet, axes = plt.subplots(figsize=(6.0, 4.4), constrained_layout=True)
    shade = axes.pcolormesh(edges(xs), edges(ys), field, cmap="Blues", vmin=0.0, vmax=1.0, alpha=0.55, rasterized=True)
    unreliable = [[0.0 if value >= figure["share"] else 1.0 for value in line] for line in field]
    nothing = ListedColormap([(0, 0, 0, 0)])
    hatch = axes.pcolor(edges(xs), edges(ys), [[v if v else float("nan") for v in line] for line in unreliable],
                        cmap=nothing, edgecolor="none", hatch="////", linewidth=0.0)
    hatch.set_edgecolor("0.35")
    hatch.set_linewidth(0.0)
    outline(axes, xs, ys, unreliable)
    axes.set_xlabel(symbol(x))
    axes.set_ylabel(symbol(y))
    bar = sheet.colorbar(shade, ax=axes)
    bar.set_label("share of trials: " + symbol(figure["of"]))
    axes.set_title("not hatched: at least %g %%" % (100 * figure["share"]), fontsize=9)
    return sheet


def outline(axes, xs, ys, unreliable):
    """The border of the region, along the borders of its cells."""
    right, up = edges(xs), edges(ys)
    for j in range(len(ys)):
        for i in range(len(xs)):
            if i > 0 and unreliable[j][i] != unreliable[j][i - 1]:
                axes.plot([right[i]] * 2, up[j:j + 2], color="black", linewidth=1.2)
            if j > 0 and unreliable[j][i] != unreliable[j - 1][i]:
                axes.plot(right[i:i + 2], [up[j]] * 2, color="black", linewidth=1.2)


DRAW = {"motion": draw_trial, "curves": draw_curves, "region": draw_region}


def save(sheet, path, **options):
    """Under its name there is what was there before, or the whole picture."""
    target = path.resolve()
    part = target.with_name("%s.%d.part" % (target.name, os.getpid()))
    with interrupts.held_back():
        try:
            sheet.savefig(part, format=path.suffix[1:], **options)
            part.replace(target)
        finally:
            part.unlink(missing_ok=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     usage=argparse.SUPPRESS)
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    set_style()
    try:
        for figure in read_figures(folder / "figures.json"):
            sheet = DRAW[figure["kind"]](figure, read_rows(folder / (figure["name"] + ".csv")))
            set_title(sheet, figure["title"])
            save(sheet, folder / (figure["name"] + ".svg"), metadata={"Date": None})
            save(sheet, folder / (figure["name"] + ".png"), dpi=150)
            plt.close(sheet)
    except (OSError, KeyError, ValueError) as error:
        sys.exit("plot_figures.py: %s: %s" % (folder, error))


if __name__ == "__main__":
    main()
