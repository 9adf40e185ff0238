"""`align accuracy`: the study of error against time from the command line."""

import csv
import os
import re
import signal
import subprocess
import time
import unittest

from align_test_case import SOURCE_ROOT, AlignTestCase


class AccuracyTest(AlignTestCase):
    def study(self, *arguments, scene=None):
        path = self.path("accuracy.csv")
        process = self.align("accuracy", scene or self.scene(), "--csv", path, *arguments)
        self.assertEqual(process.returncode, 0, process.stderr)
        with open(path, newline="") as file:
            return process.stdout, list(csv.DictReader(file))

    def test_errors_fall_with_the_tolerance(self):
        _, rows = self.study("--solvers", "event")
        self.assertEqual({row["solver"] for row in rows}, {"event"})
        settings = [float(row["setting"]) for row in rows]
        self.assertEqual(settings, [float("1e-%d" % digits) for digits in range(1, 13)])
        errors = [float(row["pose_error"]) for row in rows]
        floor = float(rows[0]["reference_agreement"])
        self.assertLess(floor, 1e-9)
        self.assertLess(errors[-1], 10 * floor + 1e-12)
        self.assertGreater(max(errors), errors[-1])
        for row in rows:
            self.assertGreater(float(row["cpu_seconds"]), 0.0)
            self.assertGreater(int(row["steps"]), 0)

    def test_every_named_solver_has_a_row(self):
        _, rows = self.study("--solvers", "implicit,event")
        self.assertEqual({row["solver"] for row in rows}, {"implicit", "event"})

    def test_columns_are_those_of_a_trial(self):
        # of a trial that ends at its time limit, so that both end at the same instant
        scene = self.scene(trial={"time_limit": 0.5})
        text, rows = self.study("--solvers", "implicit", scene=scene)
        lines = [line.split() for line in text.splitlines() if line.startswith("implicit ")]
        self.assertEqual(len(lines), len(rows))
        for row, line in zip(rows, lines):
            self.assertEqual((row["kind"], row["failure"]), ("tolerance", ""))
            counts = self.trial(scene, "--solver", "implicit", "--tolerance", row["setting"])["solver"]
            for column in ("rhs_evaluations", "steps", "rejected", "events"):
                self.assertEqual(int(row[column]), counts[column], column)
            self.assertLessEqual(int(row["repetitions"]), 50)
            self.assertEqual(line[1:5], ["%.1e" % float(row["setting"]), "%.1e" % float(row["pose_error"]),
                                         "%.1e" % float(row["force_error"]), "-"])
            self.assertAlmostEqual(float(line[5]), 1e6 * float(row["cpu_seconds"]), delta=0.06)
            self.assertEqual(line[6:9], [row["rhs_evaluations"], row["steps"], row["events"]])

    def test_a_run_without_an_answer_has_a_row_that_says_why(self):
        # steps of a thousandth of a period are too many for the limit, the coarsest is not
        text, rows = self.study("--solvers", "rk4", scene=self.scene(solver={"step_limit": 2000}))
        failed = [row for row in rows if row["failure"]]
        self.assertTrue(failed)
        self.assertLess(len(failed), len(rows))
        for row in failed:
            self.assertIn("step", row["failure"])
            self.assertEqual({row[key] for key in ("pose_error", "cpu_seconds", "steps", "events", "energy_residual")}, {""})
            self.assertEqual(row["reference_agreement"], rows[0]["reference_agreement"])
            self.assertIn(row["failure"], text)

    def test_advises_nothing_below_what_the_reference_knows(self):
        text, rows = self.study("--solvers", "event", scene="central")
        agreement = float(rows[0]["reference_agreement"])
        self.assertGreater(agreement, 1e-9, "a scene whose answer is known shows nothing here")
        self.assertIn("For an error of 1e-09: not known, the two references differ by more.", text)

    def test_says_how_good_the_reference_is(self):
        text, rows = self.study("--solvers", "event")
        agreement = "%.1e" % float(rows[0]["reference_agreement"])
        self.assertIn("reference event, implicit steps alone differ by %s\n" % agreement, text)

    def test_ends_with_advice(self):
        text, _ = self.study("--solvers", "event")
        self.assertIn("For an error of 1e-06 use event with a tolerance of", text)
        self.assertRegex(text, r"solver: {accuracy: 1e-06} picks event with a tolerance of 1.0e-08: error \S+, \d+ us")

    def test_studies_a_part_that_only_goes_up_and_down(self):
        # all of its motion in contact is stiff
        text, rows = self.study("--solvers", "event,implicit", "--set", "part.inertia=null")
        self.assertLess(float(rows[0]["reference_agreement"]), 1e-9)
        process = self.align("accuracy", "central", "--solvers", "event")
        self.assertEqual(process.returncode, 0, process.stderr)

    def test_draws_what_the_name_says(self):
        for name, begin in (("a.svg", b"<?xml"), ("a.pdf", b"%PDF"), ("a.png", b"\x89PNG")):
            self.study("--solvers", "event", "--plot", self.path(name))
            with open(self.path(name), "rb") as file:
                self.assertEqual(file.read(len(begin)), begin, name)

    def test_steps_are_in_the_scenes_own_unit_of_time(self):
        text, rows = self.study("--solvers", "rk4", "--set", "trial.time_limit=5e-3", scene="gripper_si")
        self.assertIn("; steps in s\n", text)
        # a hundredth of a period of 150 Hz
        self.assertAlmostEqual(float(rows[0]["setting"]), 0.01 / 150.0, delta=1e-9)
        step = re.search(r"For an error of 1e-03 use rk4 with a step of (\S+) s:", text).group(1)
        row = next(row for row in rows if "%.1e" % float(row["setting"]) == step)
        self.assertLess(float(row["pose_error"]), 1e-3)

    def test_peaks_do_not_hang_on_the_touch_that_ends_a_trial(self):
        _, rows = self.study("--solvers", "event", scene="insertion")
        for row in rows:
            self.assertLess(float(row["force_error"]), 1e-3, row["setting"])

    def test_rows_alone_go_to_stdout(self):
        process = self.align("accuracy", self.scene(), "--solvers", "event", "--csv", "/dev/stdout")
        self.assertEqual(process.returncode, 0, process.stderr)
        rows = list(csv.reader(process.stdout.splitlines()))
        self.assertEqual(rows[0][:3], ["solver", "kind", "setting"])
        self.assertGreater(len(rows), 5)
        self.assertEqual({(len(row), row[0]) for row in rows[1:]}, {(len(rows[0]), "event")})
        self.assertIn("For an error of 1e-06 use event", process.stderr)

    def test_a_full_disk_is_told(self):
        with open("/dev/full", "w") as full:
            process = self.align("accuracy", self.scene(), "--solvers", "event", stdout=full)
        self.assertEqual(process.returncode, 1)
        self.assertIn("stdout", process.stderr)

    def test_the_file_is_there_though_nobody_reads_the_table(self):
        read_end, write_end = os.pipe()
        os.close(read_end)
        process = self.align("accuracy", self.scene(), "--solvers", "event", "--csv", "a.csv", stdout=write_end)
        os.close(write_end)
        self.assertEqual((process.returncode, process.stderr), (-signal.SIGPIPE, ""))
        self.assertEqual(sorted(os.listdir(self.directory)), ["a.csv", "small.yaml"])

    def test_a_picture_that_cannot_be_written_is_told(self):
        os.symlink("/dev/full", self.path("full.png"))
        process = self.align("accuracy", self.scene(), "--solvers", "event", "--plot", self.path("full.png"))
        self.assertEqual(process.returncode, 1)
        self.assertIn("No space left on device", process.stderr)
        self.assertNotIn("Traceback", process.stderr)

    def test_an_interrupt_ends_it_at_the_next_step(self):
        # the reference alone takes seconds
        path = self.path("a.csv")
        process = subprocess.Popen(
            [self.align_path, "accuracy", "hard/conservative_ball", "--set", "trial.time_limit=1e6", "--csv", path],
            cwd=self.directory, env=dict(os.environ, ROS_PACKAGE_PATH=SOURCE_ROOT), stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, universal_newlines=True)
        while not os.listdir(self.directory):  # the file is begun once signals are heeded
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, text = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 130)
        self.assertIn("interrupted", text)
        self.assertEqual(os.listdir(self.directory), [])

    def test_an_interrupt_while_the_picture_is_drawn_keeps_the_table(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                process = self.interrupted_while_drawing(
                    number, "accuracy", self.scene(), "--solvers", "event", "--csv", "a.csv", "--plot", "a.png")
                self.assertEqual(process.returncode, 128 + number)
                self.assertIn("align: interrupted; no picture is written", process.stderr)
                self.assertEqual(sorted(os.listdir(self.directory)), ["a.csv", "small.yaml"])
                self.assertIn("For an error of 1e-06 use event", process.stdout)

    def test_refusals(self):
        self.assert_refused(["accuracy", self.scene(), "--solvers", "magic"], "magic", "event", "ode")
        self.assert_refused(["accuracy", self.path("none.yaml")], "none.yaml")
        self.assert_refused(["accuracy", self.scene(), "--csv", self.path("no/such/a.csv")], "--csv", "no/such/a.csv")

        self.assert_refused(["accuracy", self.scene(), "--plot", self.path("a.jpg")], "--plot", "a.jpg", ".png, .svg, .pdf")

    def test_a_refused_study_leaves_no_file(self):
        path = self.path("a.csv")
        self.assert_refused(["accuracy", self.scene(), "--set", "part.half_width=-1", "--csv", path], "half_width")
        self.assertFalse(os.path.exists(path))


if __name__ == "__main__":
    unittest.main()
