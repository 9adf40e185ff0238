"""The hard cases for scripts/hard_cases: what theory expects of each scene in config/scenes/hard, and how far a solver is off.

docs/hard_cases.md has the formulas.
"""

import math
import os

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))


# --- Theory -----------------------------------------------------------------------------------------------------------


def restitution(zeta):
    """Of a linear base that pushes only, zeta < 1."""
    beta = math.sqrt(1.0 - zeta * zeta)
    return math.exp(-zeta / beta * math.atan2(2.0 * zeta * beta, 2.0 * zeta * zeta - 1.0))


def bisect(function, low, high):
    """Where function, positive at low, changes its sign."""
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if function(middle) > 0.0 else (low, middle)
    return 0.5 * (low + high)


def rigid_time_of_rest(height, weight, e):
    v = math.sqrt((weight + height) ** 2 - weight**2)
    time = math.acos(weight / (weight + height))
    while v > 1e-18:
        v *= e
        time += 2.0 * math.atan(v / weight)
    return time


def rigid_ball(end, drop, ground, e):
    """(u, u') at `end` of u'' = -u from rest at `drop`, with impacts at u = `ground`."""
    begin, v = math.acos(ground / drop), e * math.sqrt(drop**2 - ground**2)
    while begin + 2.0 * math.atan(v / ground) < end:
        begin += 2.0 * math.atan(v / ground)
        v *= e
    s = end - begin
    return ground * math.cos(s) + v * math.sin(s), v * math.cos(s) - ground * math.sin(s)


def way_of_one_slip(amplitude, limit, rate):
    """Of a block at rest under amplitude sin(rate t), which dry friction holds up to `limit`."""
    s0 = math.asin(limit / amplitude)
    end = bisect(lambda s: amplitude * (math.cos(s0) - math.cos(s)) - limit * (s - s0), math.pi - s0, 2.0 * math.pi)
    ds = end - s0
    return (amplitude * (math.cos(s0) * ds - math.sin(end) + math.sin(s0)) - 0.5 * limit * ds * ds) / rate**2


def known_answers(scene):
    with open(os.path.join(ROOT, "test", "reference", "hard_cases.yaml")) as file:
        return yaml.safe_load(file)[scene]


# --- Figures: run -> (error, what was seen) ---------------------------------------------------------------------------
# `run` runs align on the scene with one solver: run.report(settings, until) gives its JSON, run.rows(settings, until, sample) that and
# the rows of its CSV. The error is held against the bound of the case; what was seen is a word for the table, or nothing.


def base(stiffness, zeta):
    damping = 2.0 * zeta * math.sqrt(stiffness)
    return ["base={stiffness: {y: %r}, damping: {y: %r}}" % (stiffness, damping)]


def speed_kept(report, anchor):
    """Speed after over speed before the first impact; the spring at ease at the height of touch takes some since."""
    final = report["final"]
    return math.hypot(final["vy"], final["y"] - anchor) / report["first_contact"]["approach_speed"]


def linear_impact(zeta):
    def figure(run):
        return abs(speed_kept(run.report(base(1e6, zeta)), 0.9) - restitution(zeta)), ""

    return figure


def touch_times(rows):
    """Of a ball: the events at which it goes down. It goes up when it is released and when the depth closes."""
    return [row["t"] for row in rows if row["event"] == 1.0 and row["vy"] < 0.0]


def chatter(stiffness):
    def figure(run):
        report, rows = run.rows(base(stiffness, 0.1), 0.4, 1e-4)
        if rows[-1]["n1"] == 0.0:
            return math.inf, "still in flight"
        last = touch_times(rows)[-1]
        return abs(last - rigid_time_of_rest(1e-3, 1.0, restitution(0.1))), "%d impacts" % report["impacts"]["a1"]

    return figure


def shaken_table(share_of, expected):
    """share_of: Gamma from those at which period 1 begins and doubles; expected: a pattern, or none that is period 1."""

    def figure(run):
        e, period = restitution(0.3), 2.0 * math.pi / 1000.0
        least = math.pi * (1.0 - e) / (1.0 + e)
        gamma = share_of(least, math.hypot(least, 2.0 * (1.0 + e * e) / (1.0 + e) ** 2))
        settings = base(1e10, 0.3) + [
            "excitation.amplitude=%r" % gamma,
            "excitation.phase=%r" % math.acos(min(1.0, least / gamma)),
            "initial.vy=%r" % (1.01 * period * e / (1.0 + e)),
        ]
        touches = touch_times(run.rows(settings, 199.0 * period)[1])[-21:]
        flights = [(after - before) / period for before, after in zip(touches, touches[1:])]
        seen = pattern_of(flights)
        right = seen == expected if expected else seen != "period 1"
        return (0.0 if right else math.inf), seen

    return figure


def pattern_of(flights):
    """What the last 20 flights, in periods of the table, are."""
    if len(flights) < 20:
        return "fewer than 20 bounces"
    if all(abs(flight - 1.0) < 1e-2 for flight in flights):
        return "period 1"
    if all(abs(a + b - 2.0) < 1e-2 for a, b in zip(flights, flights[1:])):
        return "period 2"
    return "other"


def swing(gap):
    return ["gripper.anchor.y=%r" % (1.125 + gap), "initial.y=%r" % (1.375 + gap)]


def grazing_scan(run):
    gaps = [sign * 1e-9 * n / 10.0 for n in range(1, 11) for sign in (1.0, -1.0)]
    wrong = sum(run.report(swing(gap))["impacts"]["a1"] != (gap < 0.0) for gap in gaps)
    return (math.inf if wrong else 0.0), "%d of %d wrong" % (wrong, len(gaps))


def grazing_speed(run):
    contact = run.report(swing(-1e-9))["first_contact"]
    if contact is None:
        return math.inf, "no impact"
    speed = math.sqrt(1e-9 * (0.5 - 1e-9))
    return abs(contact["approach_speed"] / speed - 1.0), ""


BLOCK_LIMIT = 0.4 * 0.5 / (1.0 + 1e-4)  # f N


def block_sticks(run):
    final = run.report(["excitation.amplitude=%r" % (0.99 * BLOCK_LIMIT)])["final"]
    return max(abs(final["x"] - 0.3), abs(final["vx"])), ""


def block_slips(run):
    until = (math.asin(1.0 / 1.01) + math.pi) / 3.0 - 1e-3
    final = run.report(["excitation.amplitude=%r" % (1.01 * BLOCK_LIMIT)], until)["final"]
    return abs((final["x"] - 0.3) / way_of_one_slip(1.01 * BLOCK_LIMIT, BLOCK_LIMIT, 3.0) - 1.0), ""


def coulomb_oscillator(run):
    rest = 0.3 - (0.2 - 22.0 * 0.013 * 0.5 / (1.0 + 1e-4) / 0.7)
    return abs(run.report(until=60.0)["final"]["x"] - rest), ""


def dynamic_jam(friction):
    def figure(run):
        final = run.report(["friction.coefficient=%d" % friction])["final"]
        known = known_answers("dynamic_jam")[friction]
        return max(abs(final[key] - known[i]) for i, key in enumerate(("x", "y", "phi", "vx", "vy", "omega"))), ""

    return figure


def stiff_bounce(stiffness):
    def figure(run):
        final = run.report(base(stiffness, 0.1))["final"]
        u, v = rigid_ball(4.0, 0.6, 0.3, restitution(0.1))
        return max(abs(final["y"] - 0.6 - u), abs(final["vy"] - v)), ""

    return figure


def lasting_contact(stiffness, zeta):
    def figure(run):
        return abs(run.report(base(stiffness, zeta))["final"]["x"] - known_answers("lasting_contact")["rigid_x"]), ""

    return figure


def conservative(run):
    report = run.report()
    impacts = sum(report["impacts"].values())
    drift = abs(report["energy"]["final"] / report["energy"]["initial"] - 1.0)
    return drift, "" if impacts >= 10000 else "%d impacts" % impacts


def flat_landing(run):
    report = run.report()
    if report["impacts"] != {"a1": 1, "a2": 0, "b1": 1, "b2": 0}:
        return math.inf, "a1 %(a1)d, b1 %(b1)d impacts" % report["impacts"]
    levers, speed = (0.51 - 0.7, 0.5), report["first_contact"]["approach_speed"]
    up = [speed * restitution(4000.0 / 2.0 * math.sqrt((1.0 + r * r / 0.095) / 1e8)) for r in levers]
    omega = (up[1] - up[0]) / (levers[1] - levers[0])
    final = report["final"]
    return max(abs(final["vy"] - up[0] + omega * levers[0]), abs(final["omega"] - omega)) / speed, ""


def flat_landing_mirrored(run):
    right = run.report()["final"]
    left = run.report(["initial.x=-0.7", "gripper.anchor.x=-0.7"])["final"]
    signs = {"x": -1.0, "y": 1.0, "phi": -1.0, "vx": -1.0, "vy": 1.0, "omega": -1.0}
    return max(abs(right[key] - sign * left[key]) for key, sign in signs.items()), ""


def two_edges(run):
    report = run.report()
    error = abs(speed_kept(report, 0.7) - restitution(0.1))
    return max(error, abs(report["final"]["omega"])), ""


def standing_level(run):
    """Statics: tilt, and the feet where they were. Friction may hold the part a little off: the feet, 2 a phi apart in
    height, with T = +-f f0/2 each."""
    final = run.report(until=8.0)["final"]
    stiffness = 0.01 + 2.0 * 2e3 * 2.0 ** 2 - 1.0
    tilt = 0.01 * 0.03 / stiffness
    held = 1.001 * 1.0 * 1.0 * 2.0 * tilt / stiffness
    off_tilt = max(0.0, abs(final["phi"] - tilt) - held)
    return max(off_tilt, abs(final["x"] + final["phi"]), abs(final["y"] + 1.0 / 4001.0)), ""


def wedging(share):
    def figure(run):
        least = math.tan(math.atan(0.2 / (2.0 * 0.50001)) + 0.00010996976621283757)
        last = run.rows(["friction.coefficient=%r" % (share * least)], sample=0.1)[1][-1]
        wedged = last["n2"] > 0.5 and last["nb1"] > 0.5
        return (0.0 if wedged == (share > 1.0) else math.inf), "wedged" if wedged else "pressed out"

    return figure


def jamming(share):
    def figure(run):
        outcome = run.report(["friction.coefficient=%r" % (share * 0.1)])["outcome"]
        return (0.0 if outcome == ("jammed" if share > 1.0 else "inserted") else math.inf), outcome

    return figure


def long_run(run):
    """The bounce after 100 and after 200 periods of 2 pi/3."""
    one, two = (run.report(until=periods * 2.0 * math.pi / 3.0) for periods in (100, 200))
    impacts = two["impacts"]["a1"] - one["impacts"]["a1"]
    return abs(two["final"]["y"] - one["final"]["y"]), "" if impacts == 100 else "%d impacts in 100 periods" % impacts


def has_an_end(*settings):
    """Any outcome will do; the error is the residual of the ledger."""

    def figure(run):
        report = run.report(settings)
        numbers = list(report["final"].values()) + [report["energy"]["residual"]]
        finite = all(number is not None and math.isfinite(number) for number in numbers)
        return (report["energy"]["residual"] if finite else math.inf), "" if finite else "not finite"

    return figure


# --- Cases ------------------------------------------------------------------------------------------------------------


class Case:
    """A row: a scene in one variant, what theory expects, the largest error that passes, the step of fixed-step solvers."""

    def __init__(self, scene, variant, expected, bound, step, figure):
        self.scene, self.variant, self.expected = scene, variant, expected
        self.bound, self.step, self.figure = bound, step, figure


def cases():
    """Steps are about a tenth of a radian of the base's own motion or less, but not below 1e-7."""
    rows = []
    for zeta in (0.1, 0.3, 0.6):
        rows.append(Case("linear_impact", "zeta %g" % zeta, "e = %.5f" % restitution(zeta), 1e-5, 1e-5, linear_impact(zeta)))
    for k, step in ((1e6, 1e-5), (1e10, 1e-6)):
        rows.append(Case("chatter", "k %g" % k, "rests at %.5f" % rigid_time_of_rest(1e-3, 1.0, restitution(0.1)),
                         12.0 / math.sqrt(k), step, chatter(k)))
    rows += [
        Case("shaken_table", "Gamma 1 % below the least", "not period 1", 0.0, 1e-6, shaken_table(lambda a, b: 0.99 * a, None)),
        Case("shaken_table", "Gamma 1 % above the least", "period 1", 0.0, 1e-6, shaken_table(lambda a, b: 1.01 * a, "period 1")),
        Case("shaken_table", "Gamma 1 % below doubling", "period 1", 0.0, 1e-6, shaken_table(lambda a, b: 0.99 * b, "period 1")),
        Case("shaken_table", "Gamma 1 % above doubling", "period 2", 0.0, 1e-6, shaken_table(lambda a, b: 1.01 * b, "period 2")),
        Case("grazing", "20 gaps within 1e-9", "impact iff gap < 0", 0.0, 1e-4, grazing_scan),
        Case("grazing", "excess 1e-9", "speed %.3e" % math.sqrt(1e-9 * (0.5 - 1e-9)), 1e-5, 1e-4, grazing_speed),
        Case("shaken_block", "0.99 f N", "sticks", 1e-14, 1e-3, block_sticks),
        Case("shaken_block", "1.01 f N", "slips by %.3e" % way_of_one_slip(1.01 * BLOCK_LIMIT, BLOCK_LIMIT, 3.0), 1e-5, 1e-4,
             block_slips),
        Case("coulomb_oscillator", "", "stops at 0.304265", 1e-9, 1e-3, coulomb_oscillator),
    ]
    for f in (1, 2, 4):
        rows.append(Case("dynamic_jam", "f %d" % f, "end state", 1e-9, 1e-5, dynamic_jam(f)))
    for k in (1e3, 1e6, 1e9, 1e12):
        rows.append(Case("stiff_bounce", "k %g" % k, "rigid ball", 10.0 / math.sqrt(k), max(1e-7, 0.1 / math.sqrt(k)),
                         stiff_bounce(k)))
    for k, zeta in ((1e4, 1.0), (1e10, 1.0), (1e6, 100.0), (1e10, 100.0)):
        rows.append(Case("lasting_contact", "k %g, zeta %g" % (k, zeta), "rigid block", 100.0 * zeta / k + 1e-5, 1e-5,
                         lasting_contact(k, zeta)))
    rows += [
        Case("conservative_ball", "1e4 impacts", "no drift", 1e-11, 2e-3, conservative),
        Case("conservative_part", "1e4 impacts", "no drift", 1e-11, 2e-3, conservative),
        Case("flat_landing", "", "two impacts", 1e-4, 1e-6, flat_landing),
        Case("flat_landing", "and its mirror image", "the same", 1e-11, 1e-6, flat_landing_mirrored),
        Case("two_edges", "", "e = 0.74408, no turn", 1e-5, 1e-5, two_edges),
        Case("standing_level", "", "tilt 1.875116e-8, feet at rest", 1e-14, 1e-3, standing_level),
    ]
    for share in (0.99, 1.01):
        word = "wedged" if share > 1.0 else "pressed out"
        rows.append(Case("wedging", "f = %g of the least" % share, word, 0.0, 1e-4, wedging(share)))
    for share in (0.99, 1.01):
        word = "jammed" if share > 1.0 else "inserted"
        rows.append(Case("jamming", "f = %g of the least" % share, word, 0.0, 1e-4, jamming(share)))
    rows.append(Case("long_run", "200 periods", "one impact each, the same", 1e-9, 1e-3, long_run))
    for mu in ("1e-8", "1e-6", "1e3"):
        rows.append(Case("extremes", "inertia " + mu, "an outcome, ledger", 1e-9, 1e-4, has_an_end("part.inertia=" + mu)))
    for nu in ("1e-3", "1e4"):
        rows.append(Case("extremes", "frequency " + nu, "an outcome, ledger", 1e-9, 1e-4, has_an_end("excitation.frequency=" + nu)))
    rows.append(Case("extremes", "clearance 1e-9", "an outcome, ledger", 1e-9, 1e-4, has_an_end("slot.clearance=1e-9")))
    for phi in ("1.6", "2.5", "3.14159", "-2"):
        rows.append(Case("overturned", "tilt " + phi, "an outcome, ledger", 1e-9, 1e-4,
                         has_an_end("initial.phi=" + phi, "gripper.anchor.phi=" + phi)))
    return rows
