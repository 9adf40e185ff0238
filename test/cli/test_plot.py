"""`align plot`: pictures of CSV files and bags, and what it refuses."""

import copy
import csv
import json
import os
import re
import signal
import struct
import subprocess
import time
import unittest
import xml.etree.ElementTree

from align_test_case import SOURCE_ROOT, AlignTestCase

SVG = "{http://www.w3.org/2000/svg}"
PANELS = ["a)", "b)", "c)", "d)", "e)", "f)"]


def heed_interrupts():
    """Of a process begun by a job in the background, which ignores them."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class PlotTest(AlignTestCase):
    def setUp(self):
        super().setUp()
        self.csv, self.bag = self.path("run.csv"), self.path("run.bag")
        process = self.align("trial", self.scene(), "--csv", self.csv, "--bag", self.bag)
        self.assertEqual(process.returncode, 0, process.stderr)

    def plot(self, *arguments, **options):
        process = self.align("plot", *arguments, **options)
        self.assertEqual((process.returncode, process.stderr, process.stdout), (0, "", ""))

    def paths(self, path):
        """The curves of an SVG file; comments hold the words."""
        for group in xml.etree.ElementTree.parse(path).iter(SVG + "path"):
            clipped = "clip-path" in group.attrib and "stroke: #b0b0b0" not in group.get("style", "")
            if clipped and ("#0072b2" in group.get("style", "") or "#d55e00" in group.get("style", "")):
                yield group

    def points(self, group):
        """Of a curve: how far each point is from the left of the picture, and from its top."""
        numbers = [float(word) for word in group.get("d").split() if word not in "MLz"]
        return numbers[::2], numbers[1::2]

    def words(self, path):
        """The texts of an SVG file, line by line."""
        with open(path) as file:
            return re.findall("<!-- (.*) -->", file.read())

    def tops(self, path):
        """Where each curve of an SVG file is highest, from 0 at its left end to 1; None for a level one."""
        found = []
        for group in self.paths(path):
            across, down = self.points(group)
            top = across[down.index(min(down))]
            level = max(down) - min(down) < 1e-6
            found.append(None if level else (top - across[0]) / (across[-1] - across[0]))
        return found

    def rows_of_csv(self):
        with open(self.csv) as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def rows_of_bag(self):
        import rosbag

        rows = []
        with rosbag.Bag(self.bag) as bag:
            for _, state, _ in bag.read_messages(topics=["/aligner/state"]):
                row = {key: getattr(state.dimensionless, key) for key in ("x", "y", "vx", "vy", "phi")}
                rows.append(dict(row, t=state.tau, n1=state.peak_force[state.A1], n2=state.peak_force[state.A2]))
        return rows

    def assert_curves(self, picture, rows):
        """Each curve is that of its column."""
        tops = self.tops(picture)
        self.assertEqual(len(tops), 7, "x, y, vx, vy, phi, n1, n2")
        for top, column in zip(tops, ("x", "y", "vx", "vy", "phi", "n1", "n2")):
            values = [row[column] for row in rows]
            self.assertEqual(top is None, max(values) == min(values), column)
            if top is not None:
                instant = rows[values.index(max(values))]["t"] / rows[-1]["t"]
                self.assertAlmostEqual(top, instant, delta=1e-3, msg=column)
        self.assertNotEqual(tops[-1], tops[-2], "the two edges are told apart")

    def test_draws_the_six_panels_of_a_csv_file_and_a_bag(self):
        texts = []
        rows_of_csv = self.rows_of_csv()
        for trial, rows in ((self.csv, rows_of_csv), (self.csv, rows_of_csv), (self.bag, self.rows_of_bag())):
            picture = self.path("run.svg")
            self.plot(trial, picture, "--title", "A trial of mine")
            with open(picture) as file:
                texts.append(file.read())
            for words in ["A trial of mine"] + PANELS:
                self.assertIn("<!-- %s -->" % words, texts[-1])
            self.assert_curves(picture, rows)
        self.assertEqual(texts[0], texts[1], "the same trial gives the same picture")

    def test_the_title_of_a_bag_tells_outcome_and_alignment_apart(self):
        for scene in ("fig2", "insertion"):
            process = self.align("trial", scene, "--bag", self.bag, "--json")
            result = json.loads(process.stdout)
            self.plot(self.bag, self.path("run.svg"))
            after = "after τ = %.4g" % result["duration"]
            words = {"aligned": "fig2: aligned " + after, "inserted": "insertion: inserted; aligned " + after}
            self.assertIn(words[result["outcome"]], " ".join(self.words(self.path("run.svg"))))
        self.assertGreater(result["final"]["t"], 1.1 * result["duration"], "the trial went on")

    def write_bag(self, path, messages):
        """A bag of these (topic below /aligner, message, seconds by which it comes later than it was)."""
        import rosbag
        import rospy

        with rosbag.Bag(path, "w") as bag:
            for topic, message, later in messages:
                message.header.stamp += rospy.Duration(later)
                bag.write("/aligner/" + topic, message, message.header.stamp)

    def messages_of(self, topic):
        import rosbag

        with rosbag.Bag(self.bag) as bag:
            return [message for _, message, _ in bag.read_messages(topics=["/aligner/" + topic])]

    def test_the_result_of_the_trial_before_is_not_that_of_one_that_goes_on(self):
        self.align("trial", "fig2", "--bag", self.bag)
        # it is latched: the recorder joins while the second trial runs
        result, = self.messages_of("result")
        states = self.messages_of("state")
        length = (result.header.stamp - states[0].header.stamp).to_sec() + 1.0
        joined = [("result", result, 0.0)] + [("state", state, length) for state in states[:10]]
        for messages, shown in ((joined, False), (joined + [("result", result, length)], True)):
            self.write_bag(self.path("joined.bag"), copy.deepcopy(messages))
            self.plot(self.path("joined.bag"), self.path("joined.svg"))
            self.assertEqual("aligned after" in " ".join(self.words(self.path("joined.svg"))), shown)

    def test_the_start_of_a_scene_that_gave_way_to_another_is_not_drawn(self):
        rows = self.rows_of_bag()
        own = [("state", state, 1.0) for state in self.messages_of("state")]
        other = copy.deepcopy(own[0][1])
        other.dimensionless.x, other.dimensionless.y = 3.0, 5.0
        # told once more to somebody who joined
        self.write_bag(self.path("two.bag"), copy.deepcopy([("state", other, 0.0)] * 2 + own))
        self.plot(self.path("two.bag"), self.path("two.svg"))
        self.assert_curves(self.path("two.svg"), rows)

    def test_a_title_is_drawn_as_it_is_written_and_in_lines_that_fit(self):
        title = r"Costs a $ or $\nope$, " + 20 * "pressed harder " + "and again"
        self.plot(self.csv, self.path("run.svg"), "--title", title)
        lines = [words for words in self.words(self.path("run.svg")) if words in title]
        self.assertEqual(" ".join(lines), title)
        self.assertLess(max(map(len, lines)), 75)

    def test_words_that_begin_like_options(self):
        os.rename(self.csv, self.path("-r.csv"))
        self.plot("--title=-x", "--", "-r.csv", "-x.svg")
        self.assertIn("-x", self.words(self.path("-x.svg")))

    def test_refuses_titles_that_are_no_text(self):
        for title in (b"\xff", b"a\x01b"):
            self.assert_refused(["plot", self.csv, "x.svg", "--title", os.fsdecode(title)], "--title", "not text")

    def test_a_script_that_dies_is_a_failure(self):
        os.makedirs(self.path("modules"))
        self.write("modules/matplotlib.py", "import os\nos.abort()\n")
        process = self.align("plot", self.csv, "x.png", environment={"PYTHONPATH": self.path("modules")})
        self.assertEqual(process.returncode, 1)
        self.assertIn("exit status 134", process.stderr)

    def test_says_at_which_instants_the_forces_are_known(self):
        for trial, symbol, note in ((self.csv, "$t$", "peaks between rows are missing"),
                                    (self.bag, r"$\tau$", "largest since the message before")):
            self.plot(trial, self.path("run.svg"))
            words = self.words(self.path("run.svg"))
            self.assertIn(note, words)
            self.assertEqual(words.count(symbol), len(PANELS))

    def test_numbers_beside_an_axis_are_those_of_the_curve(self):
        rows = ["%d,0,%r,0,0,0,0,0" % (t, 0.9 + t * 1e-6) for t in range(9)]
        self.plot(self.write("high.csv", "\n".join(["t,x,y,phi,vx,vy,n1,n2"] + rows)), self.path("high.svg"))
        self.assertTrue(any("0.900005" in words for words in self.words(self.path("high.svg"))))

    def test_rounding_is_not_blown_up(self):
        header = "t,x,y,phi,vx,vy,n1,n2"
        rows = ["%d,0.1,%r,%r,0,0,%r,0" % (t, 0.9 + t % 2 * 1e-15, t % 2 * 1e-15, t % 2 * 1e-15) for t in range(9)]
        self.plot(self.write("rounding.csv", "\n".join([header] + rows)), self.path("rounding.svg"))
        self.assertEqual(self.tops(self.path("rounding.svg")), 7 * [None])

    def test_the_legend_lies_above_the_forces(self):
        self.plot(self.csv, self.path("run.svg"))
        legend = next(group for group in xml.etree.ElementTree.parse(self.path("run.svg")).iter(SVG + "g")
                      if group.get("id") == "legend_1")
        sign = next(path for path in legend.iter(SVG + "path") if "#0072b2" in path.get("style", ""))
        force = list(self.paths(self.path("run.svg")))[-2]
        self.assertGreater(min(self.points(force)[1]), self.points(sign)[1][0] + 3.0)

    def test_the_ending_decides_on_the_format(self):
        self.plot(self.csv, self.path("run.png"), "--si")
        with open(self.path("run.png"), "rb") as file:
            head = file.read(24)
        self.assertEqual(head[:8], b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", head[16:24])
        self.assertGreater(width, 800)
        self.assertGreater(height, 600)
        self.plot(self.csv, self.path("run.pdf"))
        with open(self.path("run.pdf"), "rb") as file:
            self.assertEqual(file.read(5), b"%PDF-")
        self.assert_refused(["plot", self.csv, self.path("run.jpeg")], "run.jpeg", ".png", ".svg", ".pdf")

    def test_refuses_files_without_a_trial(self):
        picture = self.path("run.png")
        self.assert_refused(["plot", self.path("none.csv"), picture], "none.csv", "No such file")
        self.assert_refused(["plot", self.directory, picture], self.directory, "is a directory")
        self.assert_refused(["plot", self.write("a.txt", "t"), picture], "a.txt", ".csv or .bag")
        with open(self.csv) as file:
            lines = file.read().splitlines()
        without = self.write("a.csv", "\n".join(lines).replace("vy", "v_y"))
        self.assert_refused(["plot", without, picture], "a.csv", "has no column vy")
        for word in ("banana", "nan", "inf"):
            bad = self.write("b.csv", "\n".join(lines[:5] + [word + lines[5][lines[5].index(","):]] + lines[6:]))
            self.assert_refused(["plot", bad, picture], "b.csv", word, "must be a number")
        wrong = self.write("b.csv", "\n".join(lines[:2] + [lines[2].replace(",", ",high", 1)]))
        self.assert_refused(["plot", wrong, picture], "b.csv", "line 3: x: high", "must be a number")
        self.assert_refused(["plot", self.write("c.csv", lines[0] + "\n"), picture], "c.csv", "no motion in it")
        with open(self.path("e.csv"), "wb") as file:
            file.write(b"#ROSBAG V2.0\n\xa6\x00")
        self.assert_refused(["plot", self.path("e.csv"), picture], "e.csv", "is no CSV file")
        self.assert_refused(["plot", self.write("d.bag", "no bag"), picture], "d.bag", "not a whole bag")
        self.assert_refused(["plot", self.bag, picture, "--node", "left"], "left", "/aligner")
        self.assert_refused(["plot", self.bag, picture, "--si"], "run.bag", "--si", "no scales")
        self.assertFalse(os.path.exists(picture))
        self.assertEqual([name for name in os.listdir(self.directory) if name.endswith(".part")], [])

    def test_refuses_a_bag_of_something_else(self):
        import rosbag
        from std_msgs.msg import String

        with rosbag.Bag(self.path("other.bag"), "w") as bag:
            bag.write("/chatter", String("hello"))
        self.assert_refused(["plot", self.path("other.bag"), self.path("run.png")], "no topic state", "/chatter")

    def test_an_output_that_cannot_be_written(self):
        self.assert_refused(["plot", self.csv, self.path("no/such/a.png")], "no/such/a.png", "No such file or directory")
        self.assert_refused(["plot", self.csv, self.csv], "run.csv", ".png")
        os.symlink("/dev/full", self.path("full.png"))
        process = self.align("plot", self.csv, self.path("full.png"))
        self.assertEqual(process.returncode, 1)
        self.assertIn("No space left on device", process.stderr)
        self.assertNotIn("Traceback", process.stderr)

    def test_an_interrupt_leaves_no_picture(self):
        before = sorted(os.listdir(self.directory))
        process = self.interrupted_while_drawing(signal.SIGINT, "plot", self.csv, self.path("run.png"))
        self.assertEqual(process.returncode, 128 + signal.SIGINT)
        self.assertIn("align: interrupted; no picture is written", process.stderr)
        self.assertEqual(sorted(os.listdir(self.directory)), before)

    def interrupted(self, *command):
        """Exit status and words of a command to which Ctrl-C comes while it loads what takes longest."""
        loading = self.path("loading")
        self.write("modules/matplotlib.py", "import time; open(%r, 'w'); time.sleep(60)" % loading)
        environment = dict(os.environ, ROS_PACKAGE_PATH=SOURCE_ROOT, PYTHONPATH=self.path("modules"))
        process = subprocess.Popen(command, cwd=self.directory, env=environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, universal_newlines=True, start_new_session=True,
                                   preexec_fn=heed_interrupts)
        while not os.path.exists(loading):
            self.assertIsNone(process.poll())
            time.sleep(0.05)
        os.remove(loading)
        os.killpg(process.pid, signal.SIGINT)
        words, _ = process.communicate(timeout=30)
        return process.returncode, words

    def test_an_interrupt_ends_a_script_without_words(self):
        os.mkdir(self.path("modules"))
        for script in ("plot_accuracy.py", "plot_figures.py"):
            words = self.interrupted(os.path.join(SOURCE_ROOT, "scripts", script), self.directory)
            self.assertEqual(words, (-signal.SIGINT, ""), script)

    def test_missing_matplotlib_is_named(self):
        os.mkdir(self.path("modules"))
        self.write("modules/matplotlib.py", "raise ImportError('No module named matplotlib')")
        process = self.align("plot", self.csv, self.path("run.png"), environment={"PYTHONPATH": self.path("modules")})
        self.assertEqual(process.returncode, 1)
        self.assertIn("python3-matplotlib", process.stderr)
        self.assertNotIn("Traceback", process.stderr)


if __name__ == "__main__":
    unittest.main()
