#!/usr/bin/env python3
"""R1 by `event` and by odeint in turns, in random order, for the table of docs/accuracy.md between <!-- turns -->.

The clock of a machine may change between two speeds within minutes: of programs that take turns of seconds both meet
either. Settings are those that keep the errors in the lines of `run`, times the second least of all turns.
Usage: in_turns.py BUILD_DIRECTORY FILE.csv [TURNS]
24 turns unless given: two to three minutes. Needs the targets peers and cost.
"""
import os
import random
import sys

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "support"))
from bench_tools import ROOT, markdown, output_of, program_of, replace_table, require_program, run, stamp  # noqa: E402
from table import POSITION, keeping, read, seconds  # noqa: E402

ERRORS = (1e-6, 1e-9)
OWN, PEER = "own_event", "odeint_dopri5"
PROBLEMS = (("R1, tanh friction", "r1", "r1"), ("R1, dry friction", "r1_dry", "r1"))


def setting(runs, answers, problem, tool, error):
    if problem not in answers:
        sys.exit("%s: holds no answer to %s (peer `reference`)" % (sys.argv[2], problem))
    quickest = keeping(runs[problem][tool], answers[problem], POSITION, error)
    if quickest is None:
        sys.exit("%s: holds no run of %s that keeps %g on %s" % (sys.argv[2], tool, error, problem))
    return quickest.setting


def own_times(cost, cells):
    """Pairs of (problem, tolerance) and the CPU time of a trial, s, in random order."""
    scene = os.path.join(ROOT, "config", "scenes", "%s.yaml")
    for problem, tolerance in random.sample(cells, len(cells)):
        line = output_of([cost, "time", scene % problem, "solver.tolerance=%r" % tolerance])
        yield (problem, tolerance), 1e-6 * float(line.split()[0])


def peer_times(peer, problem):
    """Likewise of the peer, of all its tolerances."""
    for line in output_of([peer, problem]).splitlines():
        fields = line.split(",")
        yield (problem, float(fields[2])), float(fields[12])


def turns_of(word):
    """Their number; at least two, as the second least time of them counts."""
    if not word.isdecimal() or int(word) < 2:
        sys.exit("TURNS %s: must be a whole number, 2 at the least" % word)
    return int(word)


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    build, turns = sys.argv[1], turns_of(sys.argv[3]) if len(sys.argv) == 4 else 24
    cost = program_of(build, "cost")
    peer_program = require_program(os.path.join(build, "peers", "peer_" + PEER), build, "peers")
    runs, answers = read(sys.argv[2])
    rows = [(name, error, (own, setting(runs, answers, own, OWN, error)),
             (peer, setting(runs, answers, peer, PEER, error)))
            for name, own, peer in PROBLEMS for error in ERRORS]
    own_cells, problems = [row[2] for row in rows], sorted({row[3][0] for row in rows})
    times = {}
    for _ in range(turns):
        for key, time in own_times(cost, own_cells):
            times.setdefault((OWN,) + key, []).append(time)
        for problem in problems:
            for key, time in peer_times(peer_program, problem):
                times.setdefault((PEER,) + key, []).append(time)
    lines = []
    for name, error, own, peer in rows:
        ours, theirs = (sorted(times[(tool,) + key])[1] for tool, key in ((OWN, own), (PEER, peer)))
        lines.append([name, "%.0e" % error, seconds(ours), seconds(theirs), "**%.2g**" % (theirs / ours)])
    replace_table("accuracy.md", "turns",
                  stamp("bench/peers/in_turns.py") + "\n\n" + markdown(["problem", "error", "event", "odeint", "ratio"], lines))


if __name__ == "__main__":
    run(main)
