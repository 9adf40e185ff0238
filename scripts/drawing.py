"""What the drawing scripts share: matplotlib without a screen, the look of axes, and the figure of a motion.

A script that imports this ends with a message where there is no matplotlib.
"""

import sys
import textwrap

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
except ImportError as error:
    sys.exit("a picture needs matplotlib (apt-get install python3-matplotlib), which %s does not find: %s"
             % (sys.executable, error))

# Told apart also in grey and by those who see colours otherwise (Okabe and Ito).
BLUE, ORANGE = "#0072B2", "#D55E00"

# Colour and mark of each solver.
SOLVER_STYLES = {
    "event": (BLUE, "o"),
    "auto": ("#56B4E9", "s"),
    "implicit": ("#009E73", "^"),
    "semi_implicit": ("#E69F00", "v"),
    "rk4": (ORANGE, "D"),
    "ode": ("#CC79A7", "X"),
}

# The paper's symbols for the columns of a motion.
MOTION_SYMBOLS = {
    "x": r"$x_C$",
    "y": r"$y_C$",
    "vx": r"$\dot x_C$",
    "vy": r"$\dot y_C$",
    "phi": r"$\varphi$",
    "omega": r"$\dot\varphi$",
    "n1": r"$n_1$",
    "n2": r"$n_2$",
}

# Curves in the paper's order and pairing, Fig. 2 a to f.
FIG2_PANELS = (("x",), ("y",), ("vx",), ("vy",), ("phi",), ("n1", "n2"))

# A curve that moves by less, beside 1 or its own size, is drawn as level: an axis that small would show rounding.
ROUNDING = 1e-12

# Forces as tables have them.
AT_SAMPLES = "peaks between rows are missing"


def set_style():
    plt.rcParams.update({
        "font.size": 10,
        "mathtext.fontset": "cm",
        "svg.hashsalt": "figures",
        "hatch.linewidth": 0.6,
        # numbers beside an axis are those of the curve, not what is to be added to 9e-1
        "axes.formatter.useoffset": False,
        "axes.formatter.use_mathtext": True,
    })


def tidy(axes):
    axes.grid(True, color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def set_title(sheet, text):
    """Above all panels, letter by letter ($ begins no formula), in as many lines as it takes."""
    sheet.suptitle(textwrap.fill(text, 70).replace("$", r"\$"), fontsize=11)


def widen_rounding(axes):
    """An axis of rounding becomes as wide as that of a level curve."""
    low, high = axes.dataLim.intervaly
    size = max(abs(low), abs(high))
    if high - low < ROUNDING * max(1.0, size):
        margin = 0.05 * size if size > ROUNDING else 0.05
        axes.set_ylim(low - margin, high + margin)


def set_force_limits(axes):
    """From 0, of which the curves are still seen, with room for the legend above them."""
    top = 1.25 * axes.get_ylim()[1]
    axes.set_ylim(-0.02 * top, top)


def draw_motion(panels, motion, force_note, time=r"$\tau$", units=None):
    """The panels a, b, ... of a trial; where their number is odd the last one spans the sheet.

    motion maps each column to its values, "t" to the instants; force_note says at which instants the forces are known;
    time names the axis of time; units may map a column to the unit that its axis names.
    """
    units = units or {}
    lines = (len(panels) + 1) // 2
    sheet = plt.figure(figsize=(7.2, 1.75 * lines + 0.4), constrained_layout=True)
    grid = sheet.add_gridspec(lines, 2)
    instants = motion["t"]

    def label(*columns):
        unit = units.get(columns[0], "")
        return ", ".join(MOTION_SYMBOLS[column] for column in columns) + (" [%s]" % unit if unit else "")

    for number, columns in enumerate(panels):
        wide = number == len(panels) - 1 and len(panels) % 2 == 1
        axes = sheet.add_subplot(grid[number // 2, :] if wide else grid[number // 2, number % 2])
        for column, colour in zip(columns, (BLUE, ORANGE)):
            axes.plot(instants, motion[column], color=colour, linewidth=0.9, label=MOTION_SYMBOLS[column])
        axes.set_ylabel(label(*columns))
        axes.set_title("%s)" % "abcdefg"[number], loc="left", fontsize=9)
        axes.yaxis.set_offset_position("right")  # a power of ten, which on the left pushes the letter up
        if instants[-1] > instants[0]:
            axes.set_xlim(instants[0], instants[-1])
        widen_rounding(axes)
        if columns[0].startswith("n"):
            set_force_limits(axes)
            axes.set_title(force_note, loc="right", fontsize=8, color="0.4")
        if len(columns) > 1:
            axes.legend(frameon=False, ncol=2, fontsize=8, loc="upper right")
        axes.set_xlabel(time, labelpad=1)
        tidy(axes)
    sheet.align_ylabels()
    return sheet
