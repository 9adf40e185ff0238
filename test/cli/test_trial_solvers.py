"""`align trial --solver ... --step ...`: the solvers with a fixed step from the command line."""

import csv
import json
import unittest

from align_test_case import AlignTestCase

SOLVERS = ("rk4", "semi_implicit", "ode")


class FixedStepTest(AlignTestCase):
    """ode is left out of a build without the Open Dynamics Engine, and says so."""

    def solvers(self):
        found = []
        for solver in SOLVERS:
            process = self.align("trial", self.scene(), "--solver", solver, "--step", "1e-3", "--json")
            if solver == "ode" and process.returncode == 2:
                self.assertIn("libode-dev", process.stderr)
                continue
            self.assertEqual(process.returncode, 0, process.stderr)
            found.append(solver)
        return found

    def test_is_near_the_exact_solver(self):
        exact = self.trial(self.scene())
        for solver in self.solvers():
            with self.subTest(solver):
                report = self.trial(self.scene(), "--solver", solver, "--step", "1e-4")
                self.assertEqual(report["outcome"], exact["outcome"])
                for key in ("x", "y", "phi"):
                    self.assertAlmostEqual(report["final"][key], exact["final"][key], delta=5e-3)

    def test_reports_its_step_and_no_tolerance(self):
        for solver in self.solvers():
            with self.subTest(solver):
                report = self.trial(self.scene(), "--solver", solver, "--step", "1e-3", "--until", "0.5")["solver"]
                self.assertEqual(report["name"], solver)
                self.assertEqual(report["step"], 1e-3)
                self.assertNotIn("tolerance", report)
                self.assertEqual(report["steps"], 500)
                self.assertEqual(report["rejected"], 0)

    def test_takes_a_step_of_its_own_where_none_is_given(self):
        exact = self.trial(self.scene())
        for solver in self.solvers():
            with self.subTest(solver):
                report = self.trial(self.scene(), "--solver", solver)
                self.assertEqual(report["outcome"], exact["outcome"])
                self.assertAlmostEqual(report["final"]["x"], exact["final"]["x"], delta=5e-3)
                same = self.trial(self.scene(), "--solver", solver, "--step", repr(report["solver"]["step"]))
                self.assertEqual(same["final"], report["final"])

    def test_recording_changes_nothing(self):
        for solver in self.solvers():
            reports = []
            for more in ([], ["--csv", self.path("a.csv"), "--sample", "0.0013"], ["--csv", self.path("b.csv")]):
                report = self.trial(self.scene(), "--solver", solver, "--step", "1e-3", *more)
                del report["solver"]["cpu_seconds"]
                reports.append(json.dumps(report, sort_keys=True))
            self.assertEqual(len(set(reports)), 1, solver)

    def test_csv_ends_as_the_report_says(self):
        for solver in self.solvers():
            path = self.path("run.csv")
            report = self.trial(self.scene(), "--solver", solver, "--step", "1e-3", "--csv", path)
            with open(path) as file:
                last = list(csv.DictReader(file))[-1]
            for key, value in report["final"].items():
                self.assertEqual(float(last[key]), value, solver + " " + key)

    def test_step_of_an_si_scene_is_in_seconds(self):
        # the scene's unit of time is 7.9 ms
        report = self.trial("gripper_si", "--solver", "rk4", "--step", "1e-6", "--until", "0.001")
        self.assertAlmostEqual(report["solver"]["step"], 1e-6, delta=1e-18)
        self.assertEqual(report["solver"]["steps"], 1000)

    def test_step_in_the_scene(self):
        path = self.scene(solver={"name": "semi_implicit", "step": 1e-3})
        self.assertEqual(self.trial(path)["solver"]["step"], 1e-3)
        self.assertEqual(self.trial(path, "--step", "5e-4")["solver"]["step"], 5e-4)
        # another solver of the same kind keeps it, one of the other kind does not
        self.assertEqual(self.trial(path, "--solver", "rk4")["solver"]["step"], 1e-3)
        self.assertNotIn("step", self.trial(path, "--solver", "event")["solver"])

    def test_impossible_steps_are_refused(self):
        for step in ("0", "-1e-3", "nan", "inf", "x"):
            with self.subTest(step):
                self.assert_refused(["trial", self.scene(), "--solver", "rk4", "--step", step], "--step")


if __name__ == "__main__":
    unittest.main(verbosity=2)
