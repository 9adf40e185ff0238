"""`align accuracy`: the study of error against time from the command line."""

import csv
import os
import unittest

from align_test_case import AlignTestCase


class AccuracyTest(AlignTestCase):
    def study(self, *arguments):
        path = self.path("accuracy.csv")
        process = self.align("accuracy", self.scene(), "--csv", path, *arguments)
        self.assertEqual(process.returncode, 0, process.stderr)
        with open(path, newline="") as file:
            return process.stdout, list(csv.DictReader(file))

    def test_errors_fall_with_the_tolerance(self):
        _, rows = self.study("--solvers", "event")
        self.assertEqual({row["solver"] for row in rows}, {"event"})
        settings = [float(row["setting"]) for row in rows]
        self.assertEqual(settings, sorted(settings, reverse=True))
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
