"""No command overwrites a file that it reads, or writes two things to one file."""

import os
import unittest

import test_calibrate
import test_reproduce
from align_test_case import AlignTestCase
from sweep_test_case import SweepTestCase


class OverwritingTestCase(AlignTestCase):
    def contents(self):
        found = {}
        for name in sorted(os.listdir(self.directory)):
            if os.path.isfile(self.path(name)):
                with open(self.path(name), "rb") as file:
                    found[name] = file.read()
        return found

    def assert_kept(self, arguments, *words):
        """It is refused, and every file is as before, with no other one beside it."""
        before = self.contents()
        self.assert_refused(arguments, *words)
        self.assertEqual(self.contents(), before)


class InputTest(OverwritingTestCase):
    def test_the_scene_of_a_trial(self):
        self.scene()
        os.symlink("small.yaml", self.path("link.yaml"))
        for option in ("--csv", "--bag"):
            for name in ("small.yaml", "./small.yaml", self.path("small.yaml"), "link.yaml"):
                with self.subTest(option + " " + name):
                    self.assert_kept(["trial", "small.yaml", option, name], option, name + ": is the scene", "not overwritten")

    def test_the_scene_of_a_study_of_accuracy(self):
        self.scene()
        os.symlink("small.yaml", self.path("picture.png"))
        self.assert_kept(["accuracy", "small.yaml", "--csv", "./small.yaml"], "--csv", "./small.yaml: is the scene")
        self.assert_kept(["accuracy", "small.yaml", "--plot", "picture.png"], "--plot", "picture.png: is the scene")

    def test_the_trial_that_is_drawn(self):
        self.assertEqual(self.align("trial", self.scene(), "--csv", "run.csv").returncode, 0)
        os.symlink("run.csv", self.path("run.png"))
        self.assert_kept(["plot", "run.csv", "run.png"], "PICTURE", "run.png: is the trial")


class CalibrationTest(OverwritingTestCase):
    def setUp(self):
        super().setUp()
        self.scene("scene.yaml")
        self.write("first.yaml", test_calibrate.STUDY)
        self.write("second.yaml", test_calibrate.OTHER_STUDY)
        self.write("facts.yaml", test_calibrate.FACTS)
        self.write("c.yaml", test_calibrate.CALIBRATION)

    def test_its_inputs(self):
        words = {"c.yaml": "is the calibration", "facts.yaml": "is the facts file", "first.yaml": "is the study first",
                 "second.yaml": "is the study second", "scene.yaml": "is the scene of the study first"}
        for name, word in words.items():
            for option in ("--report", "--log"):
                with self.subTest(option + " " + name):
                    self.assert_kept(["calibrate", "c.yaml", option, "./" + name], option, name, word)

    def test_report_and_log(self):
        self.assert_kept(["calibrate", "c.yaml", "--report", "out", "--log", "./out"], "--report and --log name the same file")


class ReproductionTest(OverwritingTestCase):
    def test_its_inputs(self):
        self.scene("scene.yaml")
        self.write("small.yaml", test_reproduce.STUDY.replace("small.yaml", "scene.yaml"))
        self.write("marked.yaml", test_reproduce.MARKED_STUDY)
        self.write("ledger.json", test_reproduce.FACTS)
        self.assert_kept(["reproduce", "--facts", "ledger.json", "--output", "."], "ledger.json: is the facts file")
        self.write("scene.csv", self.contents()["scene.yaml"])
        self.write("small.yaml", test_reproduce.STUDY.replace("small.yaml", "scene.csv"))
        self.write("facts.yaml", test_reproduce.FACTS.replace("name: curve", "name: scene"))
        self.assert_kept(["reproduce", "--facts", "facts.yaml", "--output", "."], "figure scene", "scene.csv: is the scene of")


class OtherOutputTest(OverwritingTestCase):
    def test_of_a_trial(self):
        self.scene()
        self.write("old.csv", "old")
        for csv, bag in (("new", "./new"), ("new", self.path("new")), ("old.csv", "./old.csv"), ("a/../new", "new")):
            with self.subTest(csv + " " + bag):
                self.assert_kept(["trial", "small.yaml", "--csv", csv, "--bag", bag], "--csv and --bag name the same file")

    def test_of_a_study_of_accuracy(self):
        self.assert_kept(["accuracy", self.scene(), "--csv", "x.svg", "--plot", "./x.svg"], "--csv and --plot name the same file")

    def test_two_files_whose_names_differ_by_an_ending_are_both_there(self):
        process = self.align("trial", self.scene(), "--csv", "x.csv.part", "--bag", "x.csv")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertTrue(self.contents()["x.csv.part"].startswith(b"t,x,y"))
        self.assertTrue(self.contents()["x.csv"].startswith(b"#ROSBAG"))


class SweepTest(OverwritingTestCase, SweepTestCase):
    def test_study_and_scene(self):
        self.study()
        self.assert_kept(["sweep", "study.yaml", "--csv", "./study.yaml"], "study.yaml: is the study", "not overwritten")
        self.assert_kept(["sweep", "study.yaml", "--csv", "./small.yaml"], "small.yaml: is the scene", "not overwritten")

    def test_a_file_where_rows_are_to_grow(self):
        self.study()
        self.write("out.csv.part", "my notes\n")
        self.assert_kept(["sweep", "study.yaml", "--csv", "out.csv"], "out.csv.part", "is in the way")
        self.study("out.csv.part")
        self.assert_kept(["sweep", "out.csv.part", "--csv", "out.csv"], "out.csv.part", "is in the way")


if __name__ == "__main__":
    unittest.main()
