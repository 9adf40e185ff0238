"""`align reproduce`: ledger and figures of a facts file, on a small study of its own and on the shipped one."""

import csv
import html
import json
import os
import re
import signal
import subprocess
import sys
import time
import unittest

from align_test_case import SMALL_SCENE, SOURCE_ROOT, AlignTestCase

STUDY = """
scene: small.yaml
set: {trial.time_limit: 8}
vary:
  - gripper.pressing_force: [0.2, 0.4, 5]
  - excitation.phase: {from: 0, to: 6}
samples: {count: 4, seed: 1}
"""

MARKED_STUDY = """
scene: scene.yaml
set: {trial.time_limit: 2}
vary:
  - gripper.pressing_force: [0.2, 0.4, 5]
  - initial.x: [0.2, 0.3]
  - excitation.phase: {from: 0, to: 6}
samples: {count: 2, seed: 1}
"""

FACTS = """
studies: .
facts:
  - id: A
    says: A part that is pressed with five times the excitation keeps contact.
    why: That is what the mode says.
    expected: met
    measures:
      - {name: share, study: small, where: gripper.pressing_force == 5, of: nonimpact, rows: {take: share},
         at_least: 1, scale: 1}
  - id: B
    says: Every part bounces.
    why: It does not.
    expected: missed
    measures:
      - {name: share, study: small, of: impact, rows: {take: share}, at_least: 1, scale: 1}
figures:
  - {name: motion, title: Motion, study: small}
  - {name: curve, title: Curve, study: small, of: peak_force_a1, curves: {along: gripper.pressing_force}}
  - {name: marked, title: Marked, study: marked, of: end_time, mark: friction_impulse_a1 > 1,
     curves: {along: gripper.pressing_force, each: initial.x, point: mean}}
  - {name: region, title: Region, study: marked, of: end_time > 1, region: {x: gripper.pressing_force, y: initial.x}}
"""


class ReproduceTest(AlignTestCase):
    def reproduce(self, *arguments, facts=FACTS):
        self.scene("small.yaml")
        os.replace(self.path("small.yaml"), self.path("scene.yaml"))
        self.write("small.yaml", STUDY.replace("small.yaml", "scene.yaml"))
        self.write("marked.yaml", MARKED_STUDY)
        file = self.write("facts.yaml", facts)
        return self.align("reproduce", "--facts", file, "--output", self.path("out"), *arguments)

    def ledger(self):
        with open(self.path("out/ledger.json")) as file:
            return json.load(file)["facts"]

    def test_writes_ledger_and_figures(self):
        process = self.reproduce()
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertRegex(process.stdout, r"^fact +what the paper says.*value +bound +5 to 95 %\n")
        first, second = self.ledger()
        self.assertTrue(first["met"])
        self.assertFalse(second["met"])
        self.assertEqual(first["measures"][0]["value"], 1.0)
        # of the three pressing forces at most two let the part bounce
        self.assertLessEqual(second["measures"][0]["value"], 2 / 3)
        self.assertIn("1 of 2 facts met", process.stdout)
        with open(self.path("out/ledger.md")) as file:
            self.assertIn("| A | A part that is pressed", file.read())
        with open(self.path("out/curve.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([float(row["gripper.pressing_force"]) for row in rows], [0.2, 0.4, 5.0])
        for row in rows:
            self.assertLessEqual(float(row["low"]), float(row["median"]))
            self.assertLessEqual(float(row["median"]), float(row["high"]))
        for name in ("motion.svg", "motion.png", "curve.svg", "curve.png"):
            self.assertGreater(os.path.getsize(self.path("out/" + name)), 1000, name)

    def words(self, picture):
        with open(self.path("out/" + picture)) as file:
            return re.findall("<!-- (.*) -->", html.unescape(file.read()))

    def test_pictures_say_what_is_drawn(self):
        process = self.reproduce()
        self.assertEqual((process.returncode, process.stderr), (0, ""), "matplotlib finds nothing to say")
        self.assertIn("medians and quartiles", self.words("curve.svg"))
        self.assertIn("means and quartiles; filled: friction_impulse_a1 > 1 in at least 80 %", self.words("marked.svg"))
        self.assertIn("share of trials: end_time > 1", self.words("region.svg"))

    def test_curves_stand_beside_each_other_by_less_than_a_mark(self):
        self.reproduce("marked")
        with open(self.path("out/marked.svg")) as file:
            text = file.read()
        marks = re.findall("<use [^>]*>", text)
        first = [next(float(re.search(r'\bx="([0-9.]*)"', mark).group(1)) for mark in marks
                      if re.search("fill: ?#ffffff; ?stroke: ?" + colour, mark)) for colour in ("#0072b2", "#d55e00")]
        self.assertGreater(first[1], first[0])
        self.assertLessEqual(first[1] - first[0], 4.5001)

    def test_bounds_have_the_digits_of_the_facts_file(self):
        facts = FACTS.replace("at_least: 1,", "at_least: 0.123456,", 1)
        self.reproduce("--no-pictures", facts=facts.replace("at_least: 1,", "at_least: 0.75, at_most: 0.75,"))
        with open(self.path("out/ledger.md")) as file:
            text = file.read()
        self.assertIn("| >= 0.123456 |", text)
        self.assertIn("| = 0.75 |", text)

    def test_motion_is_that_of_the_trial(self):
        self.reproduce("--no-pictures")
        with open(self.path("out/motion.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), ["t", "x", "y", "phi", "vx", "vy", "omega", "n1", "n2"])
        self.assertEqual(float(rows[0]["t"]), 0.0)
        self.assertEqual(float(rows[0]["x"]), SMALL_SCENE["initial"]["x"])
        self.assertFalse(os.path.exists(self.path("out/motion.png")))

    def test_check_fails_only_for_what_was_expected(self):
        self.assertEqual(self.reproduce("--check", "--no-pictures").returncode, 0)
        process = self.reproduce("--check", "--no-pictures", facts=FACTS.replace("expected: missed", "expected: met"))
        self.assertEqual(process.returncode, 1)
        self.assertIn("expected to be met, and missed: B", process.stderr)
        self.assertIn("Missed, though expected to be met: B", process.stdout)
        self.assertNotIn("Met, though", process.stdout)
        process = self.reproduce("--check", "--no-pictures", facts=FACTS.replace("expected: met", "expected: missed"))
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("Met, though not expected: A", process.stdout)
        self.assertNotIn("Missed, though", process.stdout)

    def test_threads_change_nothing(self):
        texts = []
        for threads in ("1", "3"):
            self.reproduce("--threads", threads, "--no-pictures")
            with open(self.path("out/ledger.json")) as file:
                texts.append(file.read())
        self.assertEqual(texts[0], texts[1])

    def test_settings_go_to_every_trial(self):
        self.reproduce("--set", "excitation.amplitude=0.01", "--no-pictures")
        self.assertEqual(self.ledger()[1]["measures"][0]["value"], 0.0)

    def test_one_figure_alone(self):
        self.assertEqual(self.reproduce("curve", "--no-pictures").returncode, 0)
        self.assertTrue(os.path.exists(self.path("out/curve.csv")))
        self.assertFalse(os.path.exists(self.path("out/motion.csv")))

    def test_figures_of_one_study_are_all_made(self):
        process = self.reproduce("marked", "region", "marked", "--no-pictures")
        self.assertEqual(process.returncode, 0, process.stderr)
        with open(self.path("out/figures.json")) as file:
            self.assertEqual([figure["name"] for figure in json.load(file)], ["marked", "region"])

    def test_a_figure_brings_the_facts_that_other_studies_belong_to_as_well(self):
        self.write("more.yaml", STUDY.replace("small.yaml", "scene.yaml"))
        two_studies = """      - {name: other share, study: more, of: impact, rows: {take: share}, at_least: 1, scale: 1}
figures:
  - {name: other, title: Other, study: more}
"""
        facts = FACTS.replace("figures:\n", two_studies)
        for figure, ids in (("curve", ["A", "B"]), ("other", ["B"])):
            process = self.reproduce(figure, "--no-pictures", facts=facts)
            self.assertEqual(process.returncode, 0, process.stderr)
            self.assertEqual([fact["id"] for fact in self.ledger()], ids)
        self.assertEqual(len(self.ledger()[0]["measures"]), 2)

    def test_the_ledger_is_there_whatever_becomes_of_the_pictures(self):
        self.reproduce("--no-pictures")  # writes the files that it reads
        for name in os.listdir(self.path("out")):
            os.remove(self.path("out/" + name))
        process = self.interrupted_while_drawing(signal.SIGTERM, "reproduce", "--facts", "facts.yaml", "--output", "out")
        self.assertEqual(process.returncode, 128 + signal.SIGTERM)
        self.assertIn("1 of 2 facts met", process.stdout)
        self.assertIn("align: interrupted; not all pictures are drawn", process.stderr)
        self.assertEqual(sorted(os.listdir(self.path("out"))),
                         ["curve.csv", "figures.json", "ledger.json", "ledger.md", "marked.csv", "motion.csv", "region.csv"])
        os.mkdir(self.path("modules"))
        self.write("modules/matplotlib.py", "raise ImportError('No module named matplotlib')")
        process = self.align("reproduce", "--facts", "facts.yaml", "--output", "out",
                             environment={"PYTHONPATH": self.path("modules")})
        self.assertEqual(process.returncode, 1)
        self.assertIn("1 of 2 facts met", process.stdout)

    def test_a_picture_is_whole_before_a_signal_ends_the_drawing(self):
        code = """
import os, pathlib, signal, sys
sys.path.insert(0, sys.argv[1])
import plot_figures
class Sheet:
    def savefig(self, path, **options):
        path.write_text("begun")
        os.kill(os.getpid(), int(sys.argv[2]))
        path.write_text("whole")
plot_figures.save(Sheet(), pathlib.Path("picture.svg"))
print("goes on")
"""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            process = subprocess.run([sys.executable, "-c", code, os.path.join(SOURCE_ROOT, "scripts"), str(int(number))],
                                     cwd=self.directory, capture_output=True, text=True, timeout=60)
            self.assertEqual((process.returncode, process.stdout), (-number, ""), process.stderr)
            self.assertEqual(os.listdir(self.directory), ["picture.svg"])
            with open(self.path("picture.svg")) as file:
                self.assertEqual(file.read(), "whole")

    def test_an_interrupt_while_data_of_figures_are_written(self):
        self.scene("long.yaml", solver={"name": "rk4", "step": 1e-9, "step_limit": 10**12}, trial={"time_limit": 1e6},
                   initial={"x": 0.2, "y": 5.0}, excitation={"amplitude": 0.0, "frequency": 20.0})
        self.write("endless.yaml", "scene: long.yaml\n")
        facts = FACTS.replace("study: small}", "study: endless}", 1)
        process = self.reproduce("curve", "--no-pictures", facts=facts)
        self.assertEqual(process.returncode, 0, process.stderr)
        os.remove(self.path("out/ledger.md"))
        process = subprocess.Popen([self.align_path, "reproduce", "--facts", "facts.yaml", "--output", "out", "--no-pictures"],
                                   cwd=self.directory, stderr=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(process.kill)
        while process.poll() is None and not os.path.exists(self.path("out/ledger.md")):
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, messages = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 128 + signal.SIGINT)
        self.assertIn("align: interrupted; the ledger is written, not all figures are", messages)
        self.assertEqual([name for name in os.listdir(self.path("out")) if "motion" in name], [])

    def contents(self):
        """Of the files that were written: name -> bytes."""
        contents = {}
        for name in os.listdir(self.path("out")):
            with open(self.path("out/" + name), "rb") as file:
                contents[name] = file.read()
        return contents

    def on_a_full_disk(self, *command):
        """Runs it where files end at 1024 bytes."""
        script = 'ulimit -f 1; trap "" XFSZ; exec "$@"'
        return subprocess.run(["bash", "-c", script, "bash", *command], capture_output=True, text=True, timeout=120,
                              cwd=self.directory)

    def test_a_full_disk_spoils_no_file_that_is_there(self):
        self.reproduce("--no-pictures")
        before = self.contents()
        self.assertGreater(len(before["motion.csv"]), 1024)
        process = self.on_a_full_disk(self.align_path, "reproduce", "--facts", "facts.yaml", "--output", "out",
                                      "--set", "base.damping.y=0.1")
        self.assertEqual(process.returncode, 1, process.stderr)
        self.assertIn("out/motion.csv: cannot be written: File too large", process.stderr)
        after = self.contents()
        self.assertEqual(set(after), set(before))
        self.assertEqual(after["motion.csv"], before["motion.csv"])

    def test_a_full_disk_spoils_no_picture_that_is_there(self):
        self.reproduce()
        before = self.contents()
        self.assertEqual(sum(name.endswith((".svg", ".png")) for name in before), 8)
        process = self.on_a_full_disk(sys.executable, os.path.join(SOURCE_ROOT, "scripts", "plot_figures.py"), "out")
        self.assertNotEqual(process.returncode, 0)
        self.assertIn("File too large", process.stderr)
        self.assertEqual(self.contents(), before)

    def test_what_cannot_be_drawn_is_named(self):
        self.reproduce("--no-pictures")
        script = os.path.join(SOURCE_ROOT, "scripts", "plot_figures.py")
        with open(self.path("out/motion.csv")) as file:
            head, first = file.readline(), file.readline()
        for name, text, words in (("motion.csv", "", "motion.csv: holds no row"),
                                  ("motion.csv", head + first.strip() + ",1\n", "motion.csv: line 2: must be"),
                                  ("motion.csv", head + first.split(",")[0], "motion.csv: line 2: must be"),
                                  ("figures.json", "[1]", "figures.json: must be a list of figures")):
            self.write("out/" + name, text)
            process = subprocess.run([sys.executable, script, "out"], capture_output=True, text=True, timeout=120,
                                     cwd=self.directory)
            self.assertEqual(process.returncode, 1)
            self.assertIn("plot_figures.py: out: " + words, process.stderr)

    def test_says_before_it_runs_what_cannot_be_written(self):
        for name in ("ledger.json", "curve.csv", "motion.png", "figures.json"):
            os.makedirs(self.path("out/" + name))
            process = self.reproduce()
            self.assertEqual(process.returncode, 2)
            self.assertIn("--output: %s: cannot be written: Is a directory" % self.path("out/" + name), process.stderr)
            self.assertEqual(os.listdir(self.path("out")), [name])
            os.rmdir(self.path("out/" + name))

    def test_refuses_what_it_does_not_know(self):
        for setting in ("gripper.pressing_force=0.3", "excitation.phase=nonsense"):
            process = self.reproduce("--set", setting)
            self.assertEqual(process.returncode, 2)
            self.assertIn("--set %s: " % setting, process.stderr)
            self.assertIn("marked.yaml varies %s:" % setting.split("=")[0], process.stderr)
        process = self.reproduce("--set", "part.half_width=-1")
        self.assertEqual(process.returncode, 2)
        self.assertIn("(set by part.half_width=-1)", process.stderr)
        self.assertFalse(os.path.exists(self.path("out")))
        process = self.reproduce("fig9")
        self.assertEqual(process.returncode, 2)
        self.assertIn("FIGURE: fig9: there is no such figure; there are motion, curve", process.stderr)
        process = self.reproduce(facts=FACTS.replace("study: marked", "study: merked"))
        self.assertEqual(process.returncode, 2)
        self.assertIn("facts.yaml: study: merked: there is no file", process.stderr)
        process = self.reproduce(facts=FACTS.replace("of: impact", "of: impacts"))
        self.assertEqual(process.returncode, 2)
        self.assertIn("the facts or their studies are refused", process.stderr)
        self.assertIn("B: share: of: impacts", process.stderr)
        process = self.reproduce(facts=FACTS.replace("expected: missed", "expected: perhaps"))
        self.assertEqual(process.returncode, 2)
        self.assertIn("facts.1.expected: perhaps: must be met or missed", process.stderr)
        self.assert_refused(["reproduce", "--facts", self.path("none.yaml")], "none.yaml", "(these do: facts)")


if __name__ == "__main__":
    unittest.main()
