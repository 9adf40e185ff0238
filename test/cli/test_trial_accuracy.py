"""`align trial --accuracy` and `solver: {accuracy: ...}`: what is picked, and how it is reported."""

import unittest

from align_test_case import AlignTestCase


class TrialAccuracyTest(AlignTestCase):
    def test_option_and_key_are_the_same(self):
        by_option = self.trial(self.scene(), "--accuracy", "1e-6")
        by_key = self.trial(self.scene(solver={"accuracy": 1e-6}))
        by_setting = self.trial(self.scene(), "--set", "solver.accuracy=1e-6")
        for report in (by_option, by_key, by_setting):
            solver = report["solver"]
            del solver["cpu_seconds"]
            self.assertEqual(solver["name"], "event")
            self.assertEqual(solver["tolerance"], 1e-8)
            self.assertEqual(solver["accuracy"], 1e-6)
        self.assertEqual(by_option, by_key)
        self.assertEqual(by_option, by_setting)

    def test_is_kept(self):
        exact = self.trial(self.scene(), "--tolerance", "1e-13")["final"]
        for accuracy in (1e-3, 1e-6, 1e-9):
            final = self.trial(self.scene(), "--accuracy", accuracy, "--until", exact["t"])["final"]
            for key in ("x", "y", "phi"):
                self.assertLessEqual(abs(final[key] - exact[key]), accuracy)

    def test_stiff_base(self):
        scene = self.scene(base={"stiffness": {"y": 1e9}})
        report = self.trial(scene, "--accuracy", "1e-3", "--until", "0.01")
        self.assertEqual(report["solver"]["name"], "auto")

    def test_replaces_what_the_scene_gives(self):
        # an option counts more than the scene's own choice
        for solver in ({"name": "event", "tolerance": 1e-3}, {"name": "semi_implicit", "step": 1e-3}):
            with self.subTest(solver):
                report = self.trial(self.scene(solver=solver), "--accuracy", "1e-6")["solver"]
                self.assertEqual((report["name"], report["tolerance"]), ("event", 1e-8))
        scene = self.scene(solver={"accuracy": 1e-6})
        self.assertNotIn("accuracy", self.trial(scene, "--tolerance", "1e-5")["solver"])
        self.assertNotIn("accuracy", self.trial(scene, "--solver", "rk4", "--step", "1e-3")["solver"])

    def test_with_a_solver(self):
        report = self.trial(self.scene(), "--accuracy", "1e-6", "--solver", "implicit")["solver"]
        self.assertEqual((report["name"], report["tolerance"], report["accuracy"]), ("implicit", 1e-8, 1e-6))

    def test_summary_names_the_choice(self):
        process = self.align("trial", self.scene(), "--accuracy", "1e-6")
        self.assertIn("event, tolerance 1e-08, for accuracy 1e-06;", process.stdout)

    def test_help_tells_where_it_cannot_be_kept(self):
        words = " ".join(self.align("trial", "--help").stdout.split())
        self.assertIn("no tolerance keeps it: `align accuracy` tells", words)

    def test_without_it_nothing_is_said(self):
        self.assertNotIn("accuracy", self.trial(self.scene())["solver"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
