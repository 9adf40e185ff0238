"""`align calibrate`: what is found, and a search that is interrupted and goes on from its log."""

import fcntl
import json
import os
import signal
import subprocess
import time
import unittest

from align_test_case import AlignTestCase

# The force of the press at rest is pressing_force on one edge: 0.35 is met by a pressing force of 0.35.
STUDY = """
scene: scene.yaml
set: {excitation.amplitude: 0, trial.time_limit: 0.2}
"""
OTHER_STUDY = STUDY.replace("0.2}", "0.1}")

FACTS = """
studies: .
facts:
  - id: A
    says: The press is 0.35.
    why: As it says.
    expected: met
    measures:
      - {name: press, study: first, of: peak_force_a1 + peak_force_a2, rows: {take: max}, at_least: 0.349,
         at_most: 0.351, scale: 0.1}
  - id: B
    says: The other press is 0.2.
    why: As it says.
    expected: met
    measures:
      - {name: press, study: second, of: peak_force_a1 + peak_force_a2, rows: {take: max}, at_least: 0.199,
         at_most: 0.201, scale: 0.1}
"""

CALIBRATION = """
facts: facts.yaml
parameters:
  press: {from: 0.1, to: 0.9, start: 0.8}
  share: {from: 0.1, to: 1.0, start: 0.9}
settings:
  all: {gripper.pressing_force: press}
  second: {gripper.pressing_force: press * share}
readings: [{name: as it is}]
search:
  searches: 2
  population: 8
  global_evaluations: 40
  thinning: {samples: 1, grid: 1}
  rounds:
    - {searches: 2, reach: 0.1, shared_evaluations: 50, own_evaluations: 40, thinning: {samples: 1, grid: 1}}
    - {searches: 2, reach: 0.01, shared_evaluations: 50, own_evaluations: 40, thinning: {samples: 1, grid: 1}}
  local_evaluations: 40
  finalists: 2
"""


class CalibrateTest(AlignTestCase):
    def setUp(self):
        super().setUp()
        self.scene("scene.yaml")
        self.write("first.yaml", STUDY)
        self.write("second.yaml", OTHER_STUDY)
        self.write("facts.yaml", FACTS)
        self.file = self.write("calibration.yaml", CALIBRATION)

    def calibrate(self, *arguments, status=0):
        process = self.align("calibrate", self.file, *arguments)
        self.assertEqual(process.returncode, status, process.stderr)
        return process

    def read(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def log_lines(self):
        return self.read("log.jsonl").splitlines(keepends=True)

    def test_finds_what_is_common_and_what_is_a_studys_own(self):
        report = self.calibrate().stdout
        rows = [row.split(" | ") for row in report.splitlines() if row.startswith(("| press | ", "| share | "))]
        found = {row[0].strip("| "): float(row[1]) for row in rows if row[0].strip("| ") in ("press", "share") and
                 len(row) == 5}
        self.assertAlmostEqual(found["press"], 0.35, delta=2e-3)
        self.assertAlmostEqual(found["share"], 0.2 / 0.35, delta=1e-2)
        self.assertIn("2 of 2", report)

    def test_goes_on_where_its_log_ends(self):
        whole = self.calibrate().stdout
        self.assertEqual(self.calibrate("--log", self.path("log.jsonl"), "--threads", "1").stdout, whole)
        lines = self.log_lines()
        self.assertEqual(len(lines) - 1, int(whole.split()[0]), "a line for every set that was looked at")
        # what a kill leaves: half of the answers and a torn one
        torn = "".join(lines[: len(lines) // 2]) + lines[-1][:20]
        self.write("log.jsonl", torn)
        self.assertEqual(self.calibrate("--log", self.path("log.jsonl"), "--resume", "--threads", "1").stdout, whole)
        self.assertEqual(self.log_lines(), lines)

    def test_takes_answers_from_the_log(self):
        log = self.path("log.jsonl")
        self.calibrate("--log", log, "--threads", "1")
        lines = self.log_lines()
        last = json.loads(lines[-1])
        for part in last["parts"]:
            part["shortfall"] = -2.5  # no set of values has it
        self.write("log.jsonl", "".join(lines[:-1] + [json.dumps(last) + "\n"]))
        process = self.calibrate("--log", log, "--resume", "--report", self.path("report.md"))
        self.assertEqual(process.stdout, "")
        self.assertRegex(self.read("report.md"), r"\| as it is \| \d \| 2 \| -5 \|")

    def test_says_how_to_go_on_when_it_is_interrupted(self):
        self.write("calibration.yaml", CALIBRATION.replace("global_evaluations: 40", "global_evaluations: 10000000"))
        log = self.path("log.jsonl")
        process = subprocess.Popen([self.align_path, "calibrate", self.file, "--log", log], stderr=subprocess.PIPE,
                                   stdout=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and not (os.path.exists(log) and len(self.log_lines()) > 2):
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        text, messages = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 128 + signal.SIGINT, messages)
        self.assertEqual(text, "")
        self.assertIn("--resume goes on with what the log has", messages)

    def test_says_what_is_refused(self):
        self.assert_refused(["calibrate", self.path("none.yaml")], "the calibration, its facts or their studies are refused", "none.yaml")

    def test_refuses_logs_that_are_not_its_own(self):
        log = self.path("log.jsonl")
        self.calibrate("--log", log)
        before = self.read("log.jsonl")
        self.assertIn("--resume goes on with them", self.calibrate("--log", log, status=2).stderr)
        self.write("first.yaml", STUDY.replace("0.2}", "0.3}"))
        self.assertIn("is of another calibration", self.calibrate("--log", log, "--resume", status=2).stderr)
        self.write("first.yaml", STUDY)
        self.assertEqual(self.read("log.jsonl"), before)
        self.write("log.jsonl", "someone's notes\n")
        self.assertIn("is a file already", self.calibrate("--log", log, status=2).stderr)
        self.assertEqual(self.read("log.jsonl"), "someone's notes\n")
        self.write("log.jsonl", "notes without an end")
        for resume in ([], ["--resume"]):
            self.calibrate("--log", log, *resume, status=2)
            self.assertEqual(self.read("log.jsonl"), "notes without an end")
        self.assertIn("--log", self.calibrate("--resume", status=2).stderr)
        self.assertIn("cannot be written", self.calibrate("--log", self.path("no/such/log"), status=2).stderr)

    @unittest.skipUnless(os.path.exists("/proc/self/mem"), "a regular file that can be opened and not read")
    def test_refuses_a_log_that_another_one_writes(self):
        log = self.path("log.jsonl")
        with open(log, "w") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            process = self.calibrate("--log", log, "--resume", status=2)
        self.assertIn("log.jsonl: another `align calibrate` is writing it", process.stderr)
        self.assertEqual(self.read("log.jsonl"), "")

    def test_an_error_of_reading_is_not_the_end_of_the_log(self):
        os.symlink("/proc/self/mem", self.path("log.jsonl"))
        process = self.calibrate("--log", self.path("log.jsonl"), "--resume", status=2)
        self.assertIn("log.jsonl: cannot be read: Input/output error", process.stderr)

    def test_says_when_the_log_cannot_be_written(self):
        self.assertIn("/dev/full: is no file", self.calibrate("--log", "/dev/full", status=2).stderr)
        log = self.path("log.jsonl")
        # files end at 1024 bytes, as on a disk that is full
        script = 'ulimit -f 1; trap "" XFSZ; exec "$0" calibrate "$1" --log "$2"'
        process = subprocess.run(["bash", "-c", script, self.align_path, self.file, log], capture_output=True,
                                 text=True, timeout=60)
        self.assertEqual(process.returncode, 1, process.stderr)
        self.assertIn(log, process.stderr)
        # what it has is of use
        self.calibrate("--log", log, "--resume")


if __name__ == "__main__":
    unittest.main()
