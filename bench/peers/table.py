#!/usr/bin/env python3
"""Tables of processor time over error, as Markdown, from the lines that `run` printed.

An error counts for a setting if that setting and every tighter one of the same peer keep it; the time is the least of
those settings' least times (docs/accuracy.md says why not medians). Where the least of a turn is below a third of its
median the clock has jumped, and the median counts. Position errors are the largest of |x|, |y|, |phi| at the end.
Usage: table.py FILE.csv
"""
import math
import signal
import sys
from collections import defaultdict

HEAD = "peer,problem,setting,x,y,phi,vx,vy,omega,rhs,steps,events,cpu_min_s,cpu_median_s\n"
COLUMNS = HEAD.strip().split(",")
TARGETS = (1e-3, 1e-6, 1e-9)
LEAST_OF_MEDIAN = 1 / 3
DRY = "r1_dry"
USUAL_EPS = 2e-3
SMOOTH_PEERS = ("odeint_dopri5", "arkode_erk5", "cvode_adams", "cvode_bdf")
POSITION, STATE, X = slice(0, 3), slice(0, 6), slice(0, 1)


class Run:
    def __init__(self, row):
        self.peer, self.problem = row["peer"], row["problem"]
        self.setting = float(row["setting"])
        least, median = float(row["cpu_min_s"]), float(row["cpu_median_s"])
        self.time_s = median if least < LEAST_OF_MEDIAN * median else least
        self.state = [float(row[name]) for name in ("x", "y", "phi", "vx", "vy", "omega")]

    def error(self, answer, part):
        difference = [abs(a - b) for a, b in zip(self.state[part], answer[part])]
        return math.inf if any(map(math.isnan, difference)) else max(difference)


def run_of(line):
    """Raises ValueError where the line is half written, or none of a run."""
    fields = line.strip().split(",")
    if not line.endswith("\n") or len(fields) != len(COLUMNS):
        raise ValueError(line)
    return Run(dict(zip(COLUMNS, fields)))


def lines_of(path):
    try:
        with open(path, errors="replace") as file:
            return file.readlines()
    except OSError as error:
        sys.exit(f"{path}: {error.strerror}")


def runs_in(path):
    """The runs of all lines; ends with a message at a line that is none, and where there is no run."""
    number, found = 1, []
    try:
        head, *lines = lines_of(path) or [""]
        if head != HEAD:
            raise ValueError(head)
        for number, line in enumerate(lines, 2):
            found.append(run_of(line))
    except ValueError:
        sys.exit(f"{path}: line {number}: is no line of bench/peers/run")
    if all(run.peer == "reference" for run in found):
        sys.exit(f"{path}: holds no run")
    return found


def read(path):
    """runs[problem][peer], loosest setting first; the answers of the peer `reference` apart. Of several turns of one
    setting the fastest."""
    fastest, answers = {}, {}
    for run in runs_in(path):
        key = (run.problem, run.peer, run.setting)
        if run.peer == "reference":
            answers[run.problem] = run.state
        elif key not in fastest or run.time_s < fastest[key].time_s:
            fastest[key] = run
    runs = defaultdict(lambda: defaultdict(list))
    for (problem, peer, _), run in fastest.items():
        runs[problem][peer].append(run)
    for peers in runs.values():
        for series in peers.values():
            series.sort(key=lambda run: -run.setting)
    for problem, peers in runs.items():
        if problem not in answers and "odeint_dopri5" in peers:
            answers[problem] = peers["odeint_dopri5"][-1].state
    return runs, answers


def keeping(series, answer, part, target):
    """The fastest run of those that, with all tighter ones, keep the error; None where there is none."""
    kept = []
    for run in reversed(series):
        if run.error(answer, part) > target:
            break
        kept.append(run)
    return min(kept, key=lambda run: run.time_s, default=None)


def seconds(value):
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if value >= scale:
            break
    return f"{value / scale:.3g} {unit}"


def cell(run):
    return seconds(run.time_s) if run else "-"


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def eps_of(problem):
    return USUAL_EPS if problem == "r1" else float(problem[len("r1_eps_"):])


def print_agreement(runs, answers):
    print("## Agreement\n\nLargest error of the end state, position and velocity, at the tightest setting.\n"
          "For eps <= 2e-5 odeint's tightest run is the answer, hence its 0.\n")
    peers = [peer for peer in SMOOTH_PEERS if any(peer in series for series in runs.values())]
    rows = []
    for problem, series in runs.items():
        if problem in answers and any(peer in series for peer in peers):
            tightest = [series[peer][-1] if peer in series else None for peer in peers]
            rows.append([problem] + [f"{run.error(answers[problem], STATE):.1e}" if run else "" for run in tightest])
    table(["problem"] + peers, rows)


def print_times(problem, peers, answer):
    print(f"## {problem}\n")
    rows = []
    for peer, series in peers.items():
        best = min(run.error(answer, POSITION) for run in series)
        rows.append([peer] + [cell(keeping(series, answer, POSITION, t)) for t in TARGETS] + [f"{best:.0e}"])
    table(["peer"] + [f"{t:.0e}" for t in TARGETS] + ["least error"], rows)


def print_dry_limit(runs, answers):
    """Towards dry friction: the error of x against the dry answer, with the best eps."""
    dry = answers[DRY]
    family = [p for p in runs if p == "r1" or p.startswith("r1_eps_")]
    print("## R1 towards dry friction, total error\n")
    print("|x(5) - dry answer|, with the eps and tolerance (step) that are fastest.\n")
    targets = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
    rows = []
    for peer in dict.fromkeys(peer for problem in family for peer in runs[problem]):
        row = [peer]
        for target in targets:
            candidates = [(keeping(runs[p][peer], dry, X, target), p) for p in family if peer in runs[p]]
            best = min((c for c in candidates if c[0]), key=lambda c: c[0].time_s, default=None)
            row.append(f"{seconds(best[0].time_s)} (eps {eps_of(best[1]):.0e}, {best[0].setting:.0e})" if best else "-")
        rows.append(row)
    for peer, series in runs.get(DRY, {}).items():
        rows.append([peer + " (dry)"] + [cell(keeping(series, dry, X, target)) for target in targets])
    table(["peer"] + [f"{t:.0e}" for t in targets], rows)

    print("Error of x that eps itself makes:", end=" ")
    print(", ".join(f"{eps_of(p):.0e}: {abs(answers[p][0] - dry[0]):.1e}" for p in family if p in answers) + "\n")

    print("## R1 towards dry friction, integration error\n\n|x(5) - converged answer of the same eps|.\n")
    rows = []
    for peer in dict.fromkeys(peer for problem in family for peer in runs[problem]):
        for problem in family:
            if peer in runs[problem] and problem in answers:
                found = [cell(keeping(runs[problem][peer], answers[problem], X, t)) for t in TARGETS]
                rows.append([peer, f"{eps_of(problem):.0e}"] + found)
    table(["peer", "eps"] + [f"{t:.0e}" for t in TARGETS], rows)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # as with `| head`
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    runs, answers = read(sys.argv[1])
    print_agreement(runs, answers)
    for problem, peers in runs.items():
        if problem in answers and not problem.startswith("r1_eps_"):
            print_times(problem, peers, answers[problem])
    if DRY in answers:
        print_dry_limit(runs, answers)


if __name__ == "__main__":
    main()
