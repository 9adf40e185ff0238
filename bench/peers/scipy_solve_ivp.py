#!/usr/bin/env python3
"""SciPy's solve_ivp with events: RK45, DOP853, Radau and LSODA, on the compiled right-hand side of the C++ peers.

As its manual has it: each guard is an event function with `terminal` and `direction`; the integration ends at one and a
new solve_ivp begins there in the next mode. A guard that has just been an event starts at zero; where it falls and
rises within the first step, SciPy sees no change of sign, or an event at the start, again and again. Hence first_step,
a small part of the shortest contact. Output: see report.h.
Usage: scipy_solve_ivp.py LIBRARY [PROBLEM ...]
"""
import ctypes
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "scripts"))
import interrupts  # noqa: E402, F401  (before what takes its time)
import numpy as np  # noqa: E402
from scipy.integrate import solve_ivp  # noqa: E402

METHODS = ("RK45", "DOP853", "Radau", "LSODA")
PROBLEMS = ("r1", "r1_eps_5e-04", "r1_eps_1e-06", "r1_stiff", "lasting", "lasting_overdamped", "wedge")
STIFF = ("r1_stiff", "lasting_overdamped")
GUARD_COUNT = 4
ENOUGH_S, TOO_MUCH_S, LEAST_REPETITIONS = 0.3, 3.0, 5
EVENT_LIMIT = 2000
GIVE_UP_S = 10.0


class GiveUp(Exception):
    """A run that takes too long or does not end as it should."""


class TooSlow(GiveUp):
    pass


class Peer:
    """The functions of the library on NumPy arrays."""

    def __init__(self, path):
        self.library = ctypes.CDLL(path)
        self.library.peer_begin.restype = ctypes.c_double
        self.library.peer_evaluations.restype = ctypes.c_long
        self.library.peer_right_hand_side.argtypes = [ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p]
        self.library.peer_guards.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
        self.library.peer_pass.argtypes = [ctypes.c_int, ctypes.c_void_p]
        self.values = np.empty(GUARD_COUNT)
        self.guards = [self.guard(i) for i in range(GUARD_COUNT)]

    def begin(self, problem):
        start = np.empty(6)
        end_time = self.library.peer_begin(problem.encode(), start.ctypes.data_as(ctypes.c_void_p))
        if end_time < 0.0:
            sys.exit(f"no problem {problem}")
        self.give_up_at = time.process_time() + GIVE_UP_S
        return start, end_time

    def right_hand_side(self, t, s):
        s = np.ascontiguousarray(s)  # Radau's difference quotients come as columns of a matrix
        rate = np.empty(6)
        self.library.peer_right_hand_side(t, s.ctypes.data, rate.ctypes.data)
        return rate

    def guard(self, index):
        def value(_t, s):
            s = np.ascontiguousarray(s)
            self.library.peer_guards(s.ctypes.data, self.values.ctypes.data)
            if time.process_time() > self.give_up_at:
                raise TooSlow("too slow")
            return self.values[index]

        value.terminal = True
        value.direction = 1.0
        return value

    def active_guards(self, s):
        """Those that can be events in this mode: an edge in flight has one, and the other reads -1."""
        self.library.peer_guards(s.ctypes.data, self.values.ctypes.data)
        return [i for i in range(GUARD_COUNT) if i % 2 == 0 or self.values[i] != -1.0]


def integrate(peer, problem, method, tolerance):
    s, end_time = peer.begin(problem)
    first_step = 3e-5 if problem in STIFF else 1e-3
    t, steps, events = 0.0, 0, 0
    while t < end_time:
        active = peer.active_guards(s)
        solution = solve_ivp(peer.right_hand_side, (t, end_time), s, method=method, rtol=tolerance, atol=tolerance,
                             first_step=min(first_step, end_time - t), events=[peer.guards[i] for i in active])
        if solution.status < 0:
            raise GiveUp(solution.message)
        t, s = solution.t[-1], np.ascontiguousarray(solution.y[:, -1])
        steps += len(solution.t) - 1
        if solution.status == 0:
            break
        for i, times in zip(active, solution.t_events):
            if len(times):
                peer.library.peer_pass(i, s.ctypes.data)
                events += 1
        if events > EVENT_LIMIT:
            raise GiveUp("too many events")
    return s, peer.library.peer_evaluations(), steps, events


def tolerances(problem):
    per_decade = 2 if problem == "r1" else 1
    return [10.0 ** (-i / per_decade) for i in range(2 * per_decade, 12 * per_decade + 1)]


def report(name, problem, setting, run):
    """Prints a line; false where the run is too slow."""
    times, in_time = [], True
    try:
        while (sum(times) < ENOUGH_S or len(times) < LEAST_REPETITIONS) and sum(times) < TOO_MUCH_S:
            begin = time.process_time()
            end, *counts = run()
            times.append(time.process_time() - begin)
    except (GiveUp, ValueError) as error:  # ValueError: SciPy's root finder does not find the sign change again
        in_time = not isinstance(error, TooSlow)
        print(f"{name}, {problem}, setting {setting:g}: {error}", file=sys.stderr)
        end, counts, times = [np.nan] * 6, [0, 0, 0], [np.nan]
    times.sort()
    fields = [name, problem, f"{setting:.6g}"] + [f"{value:.17g}" for value in end] + [str(count) for count in counts]
    print(",".join(fields + [f"{times[0]:.4g}", f"{times[len(times) // 2]:.4g}"]), flush=True)
    return in_time


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    try:
        peer = Peer(sys.argv[1])
    except OSError as error:
        sys.exit(f"scipy_solve_ivp.py: {error}")
    for problem in [name for name in PROBLEMS if name in sys.argv[2:] or len(sys.argv) == 2]:
        for method in METHODS:
            for tolerance in tolerances(problem):
                if not report(f"scipy_{method.lower()}", problem, tolerance,
                              lambda: integrate(peer, problem, method, tolerance)):
                    break  # tighter ones take longer


if __name__ == "__main__":
    main()
