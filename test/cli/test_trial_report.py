"""`align trial`: what it reports, and that the same call gives the same bits."""

import json
import math
import os
import re
import shutil
import unittest

import yaml

from align_test_case import BALL_SI, SOURCE_ROOT, AlignTestCase

REPORT_KEYS = {
    "scene", "outcome", "mode", "duration", "final", "impacts", "peak_force", "first_contact", "energy", "solver"
}
SOLVER_KEYS = {"name", "tolerance", "steps", "rejected", "rhs_evaluations", "events", "cpu_seconds"}
STATE_KEYS = {"t", "x", "y", "phi", "vx", "vy", "omega"}
SPOTS = {"a1", "a2", "b1", "b2"}


class WorkspaceTest(AlignTestCase):
    """The package's files are found from a devel space, wherever below src/ the package is and whatever its folder."""

    def trial_in_workspace(self, package):
        """`align trial hard/linear_impact` from a workspace with the package in this folder."""
        folder = self.path(package)
        shutil.copytree(os.path.join(SOURCE_ROOT, "config"), os.path.join(folder, "config"))
        shutil.copy(os.path.join(SOURCE_ROOT, "package.xml"), folder)
        self.write("src/CMakeLists.txt", "")
        os.makedirs(self.path("src/other/share"))
        self.write("src/other/package.xml", "<package><name>other</name></package>")
        os.makedirs(self.path("devel/lib/vibratory_alignment"))
        self.write("devel/.catkin", self.path("src"))
        self.align_path = shutil.copy(self.align_path, self.path("devel/lib/vibratory_alignment/align"))
        return self.align("trial", "hard/linear_impact", environment={"ROS_PACKAGE_PATH": ""})

    def test_in_a_folder_of_another_name(self):
        process = self.trial_in_workspace("src/clone")
        self.assertEqual(process.returncode, 0, process.stderr)

    def test_in_a_folder_among_others(self):
        process = self.trial_in_workspace("src/cell/aligners/vibratory_alignment")
        self.assertEqual(process.returncode, 0, process.stderr)

    def test_not_in_another_package(self):
        process = self.trial_in_workspace("src/other/copy")
        self.assertEqual(process.returncode, 2)
        self.assertIn("hard/linear_impact: no such file", process.stderr)

    def test_not_in_a_hidden_folder(self):
        process = self.trial_in_workspace("src/.hidden")
        self.assertEqual(process.returncode, 2)
        self.assertIn("hard/linear_impact: no such file", process.stderr)


class JsonTest(AlignTestCase):
    def test_has_the_keys_of_the_contract(self):
        report = self.trial(self.scene())
        self.assertLessEqual(REPORT_KEYS, set(report))
        self.assertEqual(report["scene"], "small")
        self.assertEqual(set(report["final"]), STATE_KEYS)
        self.assertEqual(set(report["impacts"]), SPOTS)
        self.assertEqual(set(report["peak_force"]), SPOTS)
        self.assertLessEqual(SOLVER_KEYS, set(report["solver"]))
        self.assertIn("residual", report["energy"])

    def test_has_the_types_of_the_contract(self):
        report = self.trial(self.scene())
        self.assertIn(report["outcome"], {"aligned", "inserted", "jammed", "stalled", "time_limit", "failed"})
        self.assertIn(report["mode"], {"none", "impact", "nonimpact", "mixed"})
        self.assertEqual(report["units"], "dimensionless")
        for value in report["final"].values():
            self.assertIsInstance(value, float)
        for value in report["impacts"].values():
            self.assertIsInstance(value, int)
        for value in report["peak_force"].values():
            self.assertGreaterEqual(value, 0.0)
        for key in ("steps", "rejected", "rhs_evaluations", "events"):
            self.assertIsInstance(report["solver"][key], int)
        self.assertIsInstance(report["force_limit_exceeded"], bool)
        for change in report["mode_changes"]:
            self.assertEqual(set(change), {"t", "mode"})

    def test_duration_is_null_unless_aligned(self):
        report = self.trial(self.scene(), "--until", 0.1)
        self.assertNotEqual(report["outcome"], "aligned")
        self.assertIsNone(report["duration"])

    def test_first_contact_is_null_without_one(self):
        report = self.trial(self.scene(initial={"x": 0.2, "y": 5.0, "phi": 0.0}), "--until", 0.01)
        self.assertIsNone(report["first_contact"])
        self.assertEqual(report["impacts"], {"a1": 0, "a2": 0, "b1": 0, "b2": 0})

    def test_start_state_is_given_back_with_all_digits(self):
        initial = {"x": 0.1 + 0.2, "y": 5.1234567890123456, "phi": 1.0 / 3.0}
        locked = self.scene(
            gripper={"damping": {}, "pressing_force": 0.2},
            part={"half_width": 0.7, "base_distance": 0.9},
            initial=initial,
        )
        final = self.trial(locked, "--until", 0.01)["final"]
        self.assertEqual(final["x"], initial["x"])
        self.assertEqual(final["phi"], initial["phi"])

    def test_until_ends_the_run_exactly_there(self):
        self.assertEqual(self.trial(self.scene(), "--until", 0.7)["final"]["t"], 0.7)

    def test_until_may_lie_beyond_the_time_limit(self):
        self.assertEqual(self.trial(self.scene(), "--until", 4.5)["final"]["t"], 4.5)

    def test_set_changes_the_scene(self):
        plain = self.trial(self.scene())
        changed = self.trial(self.scene(), "--set", "friction.coefficient=0.4", "--set", "name=other")
        self.assertEqual(changed["scene"], "other")
        self.assertNotEqual(changed["final"], plain["final"])

    def test_one_set_takes_several_values_and_leaves_other_words_alone(self):
        scene = self.scene()
        changed = self.trial(scene, "--set", "friction.coefficient=0.4", "--set", "name=other")
        for words in (
            [scene, "--set", "friction.coefficient=0.4", "name=other"],
            ["--set", "friction.coefficient=0.4", "name=other", scene],
            ["--set=friction.coefficient=0.4", "name=other", scene],
            ["--set", "friction.coefficient=9", "--sample", "0.1", scene, "--set", "friction.coefficient=0.4", "name=other"],
        ):
            with self.subTest(words):
                report = self.trial(*words)
                self.assertEqual((report["scene"], report["final"]), ("other", changed["final"]))
        os.rename(scene, self.path("a=b.yaml"))
        self.assertEqual(self.trial("--set", "name=other", self.path("a=b.yaml"))["scene"], "other")
        process = self.align("trial", "--set", "name=other", "--", "a=b.yaml")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assert_refused(["trial", "a=b.yaml", "name=other"], "name=other")

    def test_tolerance_is_used_and_reported(self):
        report = self.trial(self.scene(), "--tolerance", "1e-6")
        self.assertEqual(report["solver"]["name"], "event")
        self.assertEqual(report["solver"]["tolerance"], 1e-6)

    def test_shipped_scene_is_found_by_name(self):
        self.assertEqual(self.trial("fig2", "--until", 0.1)["scene"], "fig2")

    def test_si_scene_reports_si(self):
        report = self.trial("gripper_si", "--until", 0.001)
        self.assertEqual(report["units"], "si")
        self.assertAlmostEqual(report["final"]["t"], 0.001, delta=1e-15)


class RepeatTest(AlignTestCase):
    def report_without_cpu_time(self, *arguments):
        report = self.trial(*arguments)
        del report["solver"]["cpu_seconds"]
        return json.dumps(report, sort_keys=True)

    def test_two_runs_are_identical(self):
        self.assertEqual(self.report_without_cpu_time(self.scene()), self.report_without_cpu_time(self.scene()))

    def test_recording_changes_nothing(self):
        plain = self.report_without_cpu_time(self.scene())
        for sample in ("0.001", "0.37", "100"):
            recorded = self.report_without_cpu_time(self.scene(), "--csv", self.path("run.csv"), "--sample", sample)
            self.assertEqual(recorded, plain, "--sample " + sample)

# What BALL_SI does: it meets the base with v = h sqrt(K/m), which turns it back.
MASS, SPRING, BASE, HEIGHT, FRICTION = 0.1, 4000.0, 4e7, 1e-3, 0.1
SPEED = HEIGHT * math.sqrt(SPRING / MASS)
FALL = 0.5 * math.pi * math.sqrt(MASS / SPRING)
PEAK = BASE * SPEED / math.sqrt((BASE + SPRING) / MASS)
LOST = FRICTION * 2.0 * SPEED  # of the velocity along x, near enough: K is next to nothing beside the base


class SiTest(AlignTestCase):
    def ball(self, **changes):
        return self.write("ball.yaml", yaml.safe_dump({**BALL_SI, **changes}))

    def assert_near(self, value, expected, share=1e-3):
        self.assertLess(abs(value - expected), share * abs(expected), (value, expected))

    def test_the_report_is_in_si_units(self):
        report = self.trial(self.ball())
        first = report["first_contact"]
        self.assertEqual(first["at"], "a1")
        self.assert_near(first["t"], FALL)
        self.assert_near(first["y"], 1.8e-3)
        self.assert_near(first["approach_speed"], SPEED)
        self.assert_near(first["vy"], -SPEED)
        self.assert_near(first["slip_velocity"], 2.0)
        self.assert_near(first["vx"], 2.0)
        self.assert_near(report["peak_force"]["a1"], PEAK)
        self.assertEqual([report["peak_force"][spot] for spot in ("a2", "b1", "b2")], [0.0, 0.0, 0.0])
        self.assert_near(report["final"]["vx"], 2.0 - LOST)
        energy, final = report["energy"], report["final"]
        self.assert_near(energy["initial"], 0.5 * MASS * 2.0**2 + 0.5 * SPRING * HEIGHT**2, 1e-9)
        self.assert_near(energy["final"], 0.5 * MASS * (final["vx"] ** 2 + final["vy"] ** 2) +
                         0.5 * SPRING * (final["y"] - 1.8e-3) ** 2, 1e-9)
        self.assert_near(energy["friction_loss"], 0.5 * MASS * (2.0**2 - (2.0 - LOST) ** 2))
        self.assertEqual((energy["base_loss"], energy["gripper_loss"], energy["excitation_work"]), (0.0, 0.0, 0.0))

    def test_steps_are_in_seconds(self):
        self.assertEqual(self.trial(self.ball(), "--solver", "rk4", "--step", "1e-6")["solver"]["step"], 1e-6)

    def test_times_of_a_trial_that_aligns_are_in_seconds(self):
        report = self.trial("gripper_si")
        self.assertEqual(report["outcome"], "aligned")
        self.assertEqual(report["duration"], report["final"]["t"])
        times = [change["t"] for change in report["mode_changes"]]
        self.assertTrue(times)
        self.assertEqual(times, sorted(times))
        self.assertLess(times[-1], report["final"]["t"])

    def test_the_terms_of_the_energy_are_the_balance(self):
        energy = self.trial("gripper_si")["energy"]
        losses = sum(energy[key] for key in ("gripper_loss", "base_loss", "friction_loss", "release_loss"))
        rest = energy["initial"] + energy["excitation_work"] + energy["turning"] - losses - energy["final"]
        self.assertLess(abs(rest), 1e-9 * energy["exchanged"])

    def test_the_summary_has_milliseconds_millimetres_and_newtons(self):
        scene = self.ball(trial={"time_limit": 0.01, "force_limit": 1.0})
        report = self.trial(scene)
        process = self.align("trial", scene)
        self.assertEqual(process.returncode, 0, process.stderr)
        text = process.stdout
        final = report["final"]
        for label, value, unit in (("time", 1e3 * final["t"], "ms"), ("x", 1e3 * final["x"], "mm"),
                                   ("y", 1e3 * final["y"], "mm"), ("tilt phi", final["phi"], "rad"),
                                   ("vx", 1e3 * final["vx"], "mm/s"), ("vy", 1e3 * final["vy"], "mm/s"),
                                   ("omega", final["omega"], "rad/s")):
            with self.subTest(label):
                number = re.search(r"(?m)^  %s +(\S+) %s$" % (label, unit), text).group(1)
                self.assertAlmostEqual(float(number), value, delta=1e-6 * abs(value))
        first = re.search(r"(?m)^First contact +a1 at (\S+) ms, approach speed (\S+) mm/s, slip velocity (\S+) mm/s$", text)
        for number, expected in zip(first.groups(), (1e3 * FALL, 1e3 * SPEED, 2e3)):
            self.assert_near(float(number), expected)
        self.assert_near(float(re.search(r"(?m)^Peak force +(\S+) +0 +0 +0 N$", text).group(1)), PEAK)
        self.assertIn("The force limit 1 N was exceeded.", text)
        self.assertNotIn("force limit", self.align("trial", self.ball()).stdout)
        milliseconds = float(re.search(r"([0-9.e+-]+) ms of CPU time", text).group(1))
        self.assertLess(abs(math.log10(milliseconds / (1e3 * report["solver"]["cpu_seconds"]))), 1.5)


class SummaryTest(AlignTestCase):
    def test_says_the_outcome_first(self):
        process = self.align("trial", self.scene())
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual(process.stderr, "")
        lines = process.stdout.splitlines()
        self.assertIn("small", lines[0])
        self.assertTrue(lines[1].startswith("Outcome"), process.stdout)

    def test_says_when_a_part_aligned_that_was_not_inserted(self):
        process = self.align("trial", "insertion", "--until", "4.5")
        self.assertRegex(process.stdout, r"Outcome +not inserted by 4.5 .*; aligned after 4.06")
        process = self.align("trial", "fig2", "--until", "1")
        self.assertRegex(process.stdout, r"Outcome +not aligned by 1 ")
        self.assertNotIn("aligned after", process.stdout)

    def test_says_when_the_balance_does_not_close(self):
        process = self.align("trial", "fig2", "--solver", "semi_implicit", "--step", "1")
        self.assertIn("not to be trusted", process.stdout)
        self.assertNotIn("not to be trusted", self.align("trial", "fig2").stdout)

    def test_has_no_si_column_without_scales(self):
        self.assertNotIn(" mm", self.align("trial", self.scene()).stdout)

    def test_has_an_si_column_with_scales(self):
        scales = {"mass": 0.1, "stiffness": 4000.0, "force": 8.0}
        self.assertIn(" mm", self.align("trial", self.scene(scales=scales)).stdout)

    def test_draws_no_progress_bar_into_a_file(self):
        self.assertNotIn("\r", self.align("trial", self.scene()).stdout)


class GeneralTest(AlignTestCase):
    def test_help(self):
        for arguments in (["--help"], ["trial", "--help"]):
            process = self.align(*arguments)
            self.assertEqual(process.returncode, 0)
            self.assertEqual(process.stderr, "")
            self.assertIn("Exit status", process.stdout)

    def test_version_is_that_of_the_package(self):
        with open(os.path.join(SOURCE_ROOT, "package.xml")) as file:
            version = file.read().split("<version>")[1].split("</version>")[0]
        process = self.align("--version")
        self.assertEqual((process.returncode, process.stdout), (0, "align %s\n" % version))

    def test_lost_report_is_an_error(self):
        with open("/dev/full", "w") as full:
            process = self.align("trial", self.scene(), stdout=full)
        self.assertEqual(process.returncode, 1)
        self.assertIn("stdout", process.stderr)

    def test_lost_help_is_an_error(self):
        for arguments in (["--help"], ["--version"], ["trial", "--help"]):
            with self.subTest(arguments), open("/dev/full", "w") as full:
                process = self.align(*arguments, stdout=full)
                self.assertEqual(process.returncode, 1)
                self.assertIn("stdout", process.stderr)

    def test_refuses_a_call_without_a_command(self):
        message = self.assert_refused([], "name a command")
        self.assertIn(self.align("--help").stdout.strip(), message, "the usage comes with it")

    def test_refuses_a_command_that_there_is_not(self):
        self.assert_refused(["trail", "fig2"], "trail", "there is no such command", "trial")


if __name__ == "__main__":
    unittest.main(verbosity=2)
