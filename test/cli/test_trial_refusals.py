"""`align trial`: bad usage and bad scenes are refused with 2 and a message that says what and why."""

import os
import unittest

from align_test_case import SMALL_SCENE, AlignTestCase


class SceneRefusalTest(AlignTestCase):
    def refuse_file(self, content, *words):
        path = self.write("bad.yaml", content)
        return self.assert_refused(["trial", path], "the scene is refused", "bad.yaml", *words)

    def refuse_setting(self, setting, *words):
        return self.assert_refused(["trial", self.scene(), "--set", setting], *words)

    def test_missing_file(self):
        self.assert_refused(["trial", "nowhere.yaml"], "nowhere.yaml")

    def test_unknown_name_lists_the_scenes_there_are(self):
        self.assert_refused(["trial", "fig99"], "fig99", "fig2", "fig3")

    def test_directory(self):
        self.assert_refused(["trial", self.directory], self.directory, "directory")

    def test_empty_file(self):
        self.refuse_file("")

    def test_file_of_comments(self):
        self.refuse_file("# nothing\n")

    def test_binary_file(self):
        self.refuse_file(bytes(range(256)) * 16)

    def test_not_yaml(self):
        self.refuse_file("part: {half_width: 0.7\nslot: ]")

    def test_not_a_map(self):
        self.refuse_file("- 1\n- 2\n")

    def test_unreadable_device(self):
        self.assert_refused(["trial", "/dev/null"], "/dev/null")

    def test_unknown_key(self):
        self.refuse_setting("part.halfwidth=1", "part.halfwidth")

    def test_unknown_section(self):
        self.refuse_setting("colour=red", "colour")

    def test_not_a_number(self):
        for value in (".nan", "nan", ".inf", "-.inf", "wide", "true", "[1]", "''"):
            with self.subTest(value):
                self.refuse_setting("part.half_width=" + value, "part.half_width")

    def test_impossible_numbers(self):
        for setting in (
            "part.half_width=-0.7",
            "part.inertia=0",
            "part.inertia=-1",
            "slot.clearance=0",
            "slot.clearance=-0.01",
            "base.stiffness.y=0",
            "base.stiffness.y=1e300",
            "base.damping.y=-1",
            "friction.coefficient=-0.1",
            "excitation.frequency=0",
            "trial.time_limit=0",
            "solver.tolerance=0",
            "solver.tolerance=1",
        ):
            with self.subTest(setting):
                self.refuse_setting(setting, *setting.split("="))

    def test_negative_mass(self):
        self.assert_refused(["trial", "gripper_si", "--set", "part.mass=-0.2"], "part.mass", "-0.2", "set by part.mass=-0.2")
        self.assert_refused(["trial", "fig2", "--set", "foo.bar=1"], "foo", "unknown key", "(set by foo.bar=1)")

    def test_missing_sections(self):
        for key in ("part", "slot", "base", "contacts", "excitation", "trial"):
            with self.subTest(key):
                path = self.scene(without=[key])
                self.assert_refused(["trial", path], path, key, "missing")

    def test_two_heights_of_the_anchor(self):
        self.refuse_setting("gripper.anchor.y=0.5", "pressing_force", "anchor.y")

    def test_every_fault_is_named(self):
        slot = dict(SMALL_SCENE["slot"], clearance=0)
        path = self.scene(slot=slot, without=["base"], colour="red")
        self.assert_refused(["trial", path], "slot.clearance", "base.stiffness.y", "colour")

    def test_start_far_outside_the_base(self):
        message = self.assert_refused(["trial", self.scene(initial={"x": 1e6})])
        self.assertNotEqual(message.strip(), "")

    def test_unknown_solver_in_the_scene(self):
        self.refuse_setting("solver.name=magic", "solver.name", "magic", "event")

    def test_settings_that_are_none(self):
        for setting in ("part", "=1", "part.=1", "part.half_width.more=1", "excitation.7.phase=1", "part.half_width="):
            with self.subTest(setting):
                self.refuse_setting(setting)


class UsageRefusalTest(AlignTestCase):
    def refuse(self, arguments, *words):
        self.assert_refused(["trial", self.scene()] + arguments, *words)

    def test_unknown_command(self):
        self.assert_refused(["fly"], "fly")

    def test_unknown_option(self):
        self.refuse(["--quick"], "--quick", "there is no such option")

    def test_misspelt_names_are_guessed(self):
        self.assert_refused(["trail", "fig2"], "did you mean trial?")
        self.assert_refused(["trial", "hard/jaming"], "did you mean hard/jamming?")
        self.refuse(["--tolerence", "1e-3"], "--tolerence", "did you mean --tolerance?")
        self.refuse(["--sover=rk4"], "--sover:", "did you mean --solver?")

    def test_missing_scene(self):
        self.assert_refused(["trial"], "SCENE")

    def test_two_scenes(self):
        self.refuse([self.scene("other.yaml")], "other.yaml")

    def test_unknown_solver_lists_the_solvers(self):
        self.refuse(
            ["--solver", "magic"], "magic", "event", "implicit", "rk4", "semi_implicit", "ode", "auto"
        )

    def test_numbers(self):
        for option in ("--tolerance", "--until", "--sample"):
            for value in ("0", "-1", "nan", "inf", "-inf", "1e400", "1e-400", "", "x", "1x", "0x10"):
                with self.subTest(option=option, value=value):
                    self.refuse([option, value], option)

    def test_numbers_of_the_solver_name_option_value_and_range(self):
        for option, value, allowed in (
            ("--tolerance", "1", "a number > 0 and <= 0.1"),
            ("--tolerance", "0", "a number > 0 and <= 0.1"),
            ("--tolerance", "1e-101", "from 1e-100 to 1e100"),
            ("--accuracy", "1", "a number from 1e-9 to 0.1"),
            ("--accuracy", "0", "a number from 1e-9 to 0.1"),
            ("--step", "0", "a number > 0"),
            ("--step", "1e101", "from 1e-100 to 1e100"),
        ):
            with self.subTest(option=option, value=value):
                message = self.assert_refused(["trial", self.scene(), option, value], option + ": " + value, allowed)
                self.assertNotIn("solver.", message)
                self.assertNotIn(".yaml", message)

    def test_step_of_a_solver_that_chooses_its_steps(self):
        self.refuse(["--step", "1e-3"], "--step", "--tolerance")

    def test_tolerance_of_a_fixed_step_solver(self):
        self.refuse(["--solver", "rk4", "--tolerance", "1e-6"], "--tolerance", "--step")

    def test_accuracy(self):
        for value in ("0", "-1e-6", "nan", "inf", "1", "1e-12", "", "x"):
            with self.subTest(value=value):
                self.refuse(["--accuracy", value], "--accuracy")
        self.refuse(["--accuracy", "1e-6", "--tolerance", "1e-6"], "--accuracy", "--tolerance")
        self.refuse(["--accuracy", "1e-6", "--step", "1e-3"], "--accuracy", "--step")
        self.refuse(["--accuracy", "1e-6", "--solver", "rk4"], "--accuracy", "rk4", "--step")
        self.refuse(["--accuracy", "1e-6", "--set", "solver.tolerance=1e-6"], "solver.accuracy", "solver.tolerance")

    def test_step_and_tolerance(self):
        self.refuse(["--step", "1e-3", "--tolerance", "1e-6"], "--step", "--tolerance")

    def test_sample_that_would_never_end(self):
        self.refuse(["--sample", "1e-30", "--csv", "run.csv"], "--sample")

    def test_setting_without_value(self):
        self.refuse(["--set"], "--set")


class OutputRefusalTest(AlignTestCase):
    def refuse(self, arguments, *words):
        self.assert_refused(["trial", self.scene()] + arguments, *words)

    def test_directory_that_is_not_there(self):
        for option in ("--csv", "--bag"):
            with self.subTest(option):
                self.refuse([option, "nowhere/run"], option, "nowhere/run", "No such file or directory")

    def test_directory_as_a_file(self):
        for option in ("--csv", "--bag"):
            with self.subTest(option):
                self.refuse([option, self.directory], option, self.directory, "directory")

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_no_permission(self):
        path = self.write("run.csv", "old")
        os.chmod(path, 0o444)
        self.refuse(["--csv", path], path, "Permission denied")

    def test_the_scene_itself(self):
        path = self.scene()
        with open(path) as file:
            before = file.read()
        self.assert_refused(["trial", path, "--csv", path], path)
        with open(path) as file:
            self.assertEqual(file.read(), before)

    def test_one_file_twice(self):
        self.refuse(["--csv", "run", "--bag", "run"], "--csv", "--bag")

    def test_refused_run_leaves_no_file(self):
        self.refuse(["--csv", "run.csv", "--bag", "nowhere/run.bag"])
        self.assertEqual(os.listdir(self.directory), ["small.yaml"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
