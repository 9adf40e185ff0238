"""The scenes of the hard cases are found by name, and docs/hard_cases.md says of each what the solvers do on it."""

import glob
import os
import signal
import subprocess
import sys
import time
import unittest

from align_test_case import SOURCE_ROOT, AlignTestCase


def names():
    folder = os.path.join(SOURCE_ROOT, "config", "scenes", "hard")
    return sorted(os.path.splitext(os.path.basename(path))[0] for path in glob.glob(os.path.join(folder, "*.yaml")))


class HardScenesTest(AlignTestCase):
    def test_there_are_some(self):
        self.assertGreaterEqual(len(names()), 17)

    def test_run_by_name(self):
        for name in names():
            with self.subTest(name):
                report = self.trial("hard/" + name, "--until", "0.001")
                self.assertEqual(report["scene"], name)
                self.assertEqual(report["final"]["t"], 0.001)

    def test_are_explained_and_tabulated(self):
        with open(os.path.join(SOURCE_ROOT, "docs", "hard_cases.md")) as file:
            text, table = file.read().split("<!-- table -->")[:2]
        for name in names():
            with self.subTest(name):
                self.assertIn("`%s`" % name, text)
                self.assertIn("`%s`" % name, table)

    def table_row(self, scene):
        """What scripts/hard_cases says of a scene with one variant: {column: words}."""
        script = os.path.join(SOURCE_ROOT, "scripts", "hard_cases")
        command = [sys.executable, script, "--align", self.align_path, "--only", scene]
        lines = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                               universal_newlines=True, timeout=120).stdout.splitlines()
        rows = [[word.strip() for word in line.split("|")[1:-1]] for line in lines if line.startswith("| ")]
        self.assertEqual(len(rows), 2)
        return dict(zip(rows[0], rows[1]))

    def test_table_takes_no_crash_for_a_run_that_lasts_too_long(self):
        crash = self.program("crash", "kill -SEGV $$")
        script = os.path.join(SOURCE_ROOT, "scripts", "hard_cases")
        process = subprocess.run([sys.executable, script, "--align", crash, "--only", "coulomb_oscillator"],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=120)
        self.assertNotEqual(process.returncode, 0)
        self.assertNotIn("stopped after", process.stdout)
        self.assertIn("ended by signal 11", process.stderr)

    def program(self, name, text):
        path = self.write(name, "#!/bin/sh\n" + text + "\n")
        os.chmod(path, 0o755)
        return path

    def test_table_refuses_what_it_does_not_know(self):
        script = os.path.join(SOURCE_ROOT, "scripts", "hard_cases")
        for align, name, words in ((self.align_path, "chatter,nonsense", "no scene nonsense; there are"),
                                   (self.path("none"), "chatter", "there is no such program"),
                                   (self.program("mute", ""), "chatter", "prints no report")):
            process = subprocess.run([sys.executable, script, "--align", align, "--only", name], stdout=subprocess.PIPE,
                                     stderr=subprocess.PIPE, universal_newlines=True, timeout=120)
            self.assertEqual((process.returncode, process.stdout), (1, ""), process.stderr)
            self.assertIn(words, process.stderr)
            self.assertNotIn("Traceback", process.stderr)

    def test_table_can_be_interrupted(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            begun = self.path("begun_" + number.name)
            slow = self.program("slow", "echo $$ >>%s\nexec sleep 600" % begun)
            process = subprocess.Popen(
                [sys.executable, os.path.join(SOURCE_ROOT, "scripts", "hard_cases"), "--align", slow, "--print"],
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                # ignored in a job in the background, or under nohup
                preexec_fn=lambda: [signal.signal(ignored, signal.SIG_DFL) for ignored in (signal.SIGINT, signal.SIGHUP)])
            self.addCleanup(process.kill)
            while process.poll() is None and not (os.path.exists(begun) and os.path.getsize(begun) > 0):
                time.sleep(0.01)
            process.send_signal(number)
            _, messages = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 128 + number, messages)
            self.assertNotIn("Traceback", messages)
            with open(begun, encoding="ascii") as text:
                for started in text:
                    self.assertRaises(ProcessLookupError, os.kill, int(started), 0)

    # closed form: the exact solvers pass, the creep of rk4 does not
    def test_table_tells_right_from_wrong(self):
        row = self.table_row("coulomb_oscillator")
        for solver in ("event", "implicit", "auto"):
            self.assertTrue(row[solver].startswith("passes"), row)
        self.assertTrue(row["rk4"].startswith("**off**"), row)


if __name__ == "__main__":
    unittest.main(verbosity=2)
