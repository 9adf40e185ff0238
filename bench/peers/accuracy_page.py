#!/usr/bin/env python3
"""Writes the tables and the figure of docs/accuracy.md from the lines that `run` printed.

Tables go between the lines <!-- results -->, the figure to docs/images/accuracy.svg. What counts as keeping an error:
table.py.
Usage: accuracy_page.py FILE.csv
"""
import contextlib
import datetime
import io
import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
sys.path += [os.path.join(ROOT, "scripts"), os.path.join(ROOT, "bench", "support")]
import interrupts  # noqa: E402, F401  (before what takes its time)
from bench_tools import with_table, write_files  # noqa: E402
from drawing import SOLVER_STYLES, plt  # noqa: E402
from table import POSITION, cell, keeping, read, seconds, table  # noqa: E402

PAGE = os.path.join(ROOT, "docs", "accuracy.md")
FIGURE = os.path.join(ROOT, "docs", "images", "accuracy.svg")
ERRORS = (1e-3, 1e-6, 1e-9)
OWN = "own_"
# What is shown, the problem of the own solvers, and the one of the peers: for dry friction their tanh approximation.
SHOWN = (
    ("R1, tanh friction", "r1", "r1"),
    ("R1, dry friction", "r1_dry", "r1"),
    ("R1 on a base 1000 times as stiff, tanh", "r1_stiff", "r1_stiff"),
    ("the same, dry", "r1_stiff_dry", "r1_stiff"),
    ("lasting contact, tanh", "lasting", "lasting"),
    ("lasting contact, dry", "lasting_dry", "lasting"),
    ("lasting contact on a stiff overdamped base, tanh", "lasting_overdamped", "lasting_overdamped"),
    ("the same, dry", "lasting_overdamped_dry", "lasting_overdamped"),
)
# Colour and mark of the best peers; those of the own solvers are strong ones as well, all others grey.
BEST_PEERS = {"odeint_dopri5": ("black", "o"), "cvode_bdf": ("#8C1C13", "s"), "cvode_adams": ("#C0584F", "D")}
OTHER_MARKS = ("o", "s", "^", "v", "D", "X", "P", "<", ">", "*", "p")
OTHER_COLOURS = ("0.62", "0.72", "0.52")
# Peers that know dry friction are compared on it.
DRY_PEERS = ("ode_world_step",)


def processor():
    with open("/proc/cpuinfo") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return f"{names[0] if names else 'unknown processor'}, {os.cpu_count()} cores"


def series_of(runs, own_problem, peer_problem):
    """{name: (runs, problem)}: own solvers on their problem, the others on theirs."""
    found = {}
    for name, series in runs.get(own_problem, {}).items():
        if name.startswith(OWN) or name in DRY_PEERS:
            found[name] = (series, own_problem)
    for name, series in runs.get(peer_problem, {}).items():
        if not name.startswith(OWN) and name not in found:
            found[name] = (series, peer_problem)
    return found


def what_is_missing(runs, answers):
    """Words for a problem of SHOWN that has no answer, or no run of an own solver or of a peer; None where all is there."""
    for _, own_problem, peer_problem in SHOWN:
        owns = {name.startswith(OWN) for name in series_of(runs, own_problem, peer_problem)}
        if True not in owns:
            return f"no run of an own solver on {own_problem}"
        if False not in owns:
            return f"no run of a peer on {peer_problem}"
        for problem in (own_problem, peer_problem):
            if problem not in answers:
                return f"no answer to {problem} (peer `reference`)"
    return None


def best_of(found, answers, error, own):
    kept = [(keeping(series, answers[problem], POSITION, error), name) for name, (series, problem) in found.items()
            if name.startswith(OWN) == own]
    return min(((run, name) for run, name in kept if run), key=lambda pair: pair[0].time_s, default=None)


def print_ratios(runs, answers):
    print("### The best own solver against the best peer\n")
    rows = []
    for title, own_problem, peer_problem in SHOWN:
        found = series_of(runs, own_problem, peer_problem)
        row = [title]
        for error in ERRORS[1:]:
            own, peer = best_of(found, answers, error, True), best_of(found, answers, error, False)
            row += [f"{seconds(own[0].time_s)} ({own[1][len(OWN):]})" if own else "-",
                    f"{seconds(peer[0].time_s)} ({peer[1]})" if peer else "-",
                    f"**{peer[0].time_s / own[0].time_s:.2g}**" if own and peer else "-"]
        rows.append(row)
    table(["problem", "own, 1e-6", "peer, 1e-6", "ratio", "own, 1e-9", "peer, 1e-9", "ratio"], rows)


def print_all(runs, answers):
    for title, own_problem, peer_problem in SHOWN:
        found = series_of(runs, own_problem, peer_problem)
        if not found:
            continue
        print(f"### {title} (`{own_problem}`" + (f", peers on `{peer_problem}`)\n" if own_problem != peer_problem else ")\n"))
        rows = []
        for name, (series, problem) in found.items():
            least = min(run.error(answers[problem], POSITION) for run in series)
            rows.append([name.replace(OWN, "**own** ")] +
                        [cell(keeping(series, answers[problem], POSITION, error)) for error in ERRORS] + [f"{least:.0e}"])
        table(["solver"] + [f"{error:.0e}" for error in ERRORS] + ["least error"], rows)


def style_of(name, others):
    """How a tool is drawn; `others`: those without a colour of their own."""
    if name.startswith(OWN):
        if name[len(OWN):] not in SOLVER_STYLES:
            sys.exit(f"{name}: has no colour and mark in SOLVER_STYLES of scripts/drawing.py")
        colour, mark = SOLVER_STYLES[name[len(OWN):]]
        style = {"color": colour, "marker": mark, "markersize": 4.5, "linewidth": 1.6, "zorder": 4}
        # `auto` often is `event` or `implicit`: both stay to be seen
        return style if name != "own_auto" else dict(style, markersize=8.0, markerfacecolor="none", linestyle="--", zorder=3)
    if name in BEST_PEERS:
        colour, mark = BEST_PEERS[name]
        return {"color": colour, "marker": mark, "markersize": 3.0, "linewidth": 1.2, "linestyle": "--", "zorder": 2.5}
    i = others.index(name)
    return {"color": OTHER_COLOURS[i % len(OTHER_COLOURS)], "marker": OTHER_MARKS[i % len(OTHER_MARKS)], "markersize": 3.0,
            "linewidth": 0.7, "zorder": 2}


def kept_points(series, answer):
    """(error that the setting and all tighter ones keep, time), coarse to tight."""
    points, most = [], 1e-16
    for run in reversed(series):
        most = max(most, run.error(answer, POSITION))
        points.append((most, run.time_s))
    return [(error, time) for error, time in reversed(points) if error < 1.0]


def drawing(runs, answers):
    """The figure, as the bytes of its file."""
    shown = [entry for entry in SHOWN if entry[1] in ("r1", "r1_dry", "r1_stiff", "lasting_overdamped")]
    figure, panels = plt.subplots(2, 2, figsize=(11.0, 8.5), sharex=True)
    names = sorted({name for entry in shown for name in series_of(runs, *entry[1:])}, key=lambda n: (not n.startswith(OWN), n))
    others = [name for name in names if not name.startswith(OWN) and name not in BEST_PEERS]
    lines = {}
    for panel, (title, own_problem, peer_problem) in zip(panels.flat, shown):
        for name, (series, problem) in series_of(runs, own_problem, peer_problem).items():
            points = kept_points(series, answers[problem])
            lines[name], = panel.loglog(*(zip(*points) if points else ((), ())), **style_of(name, others))
        panel.set_title(title if own_problem == peer_problem else f"{title} (peers: tanh)", fontsize=10)
        panel.set_xlim(1.0, 1e-15)
        panel.grid(True, which="major", linewidth=0.3)
    for panel in panels[1]:
        panel.set_xlabel("error of x, y, phi at the end")
    for panel in panels[:, 0]:
        panel.set_ylabel("processor time, s")
    order = [name for name in (*(OWN + solver for solver in SOLVER_STYLES), *BEST_PEERS, *others) if name in lines]
    figure.legend([lines[name] for name in order], [name.replace(OWN, "own: ") for name in order],
                  loc="lower center", ncol=6, fontsize=8, frameon=False)
    figure.tight_layout(rect=(0.0, 0.07, 1.0, 1.0))
    picture = io.BytesIO()
    figure.savefig(picture, format="svg", metadata={"Date": None})
    return picture.getvalue()


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    runs, answers = read(sys.argv[1])
    missing = what_is_missing(runs, answers)
    if missing:
        sys.exit(f"{sys.argv[1]}: holds {missing}, which docs/accuracy.md shows")
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        print(f"Made on {datetime.date.today()}, {processor()}.\n")
        print_ratios(runs, answers)
        print("![Error against processor time](images/accuracy.svg)\n")
        print_all(runs, answers)
    write_files({PAGE: with_table(PAGE, "results", text.getvalue()), FIGURE: drawing(runs, answers)})


if __name__ == "__main__":
    main()
