"""`align trial`: the CSV file and the bag that it writes, and what is left when it cannot."""

import csv
import json
import os
import resource
import signal
import subprocess
import time
import unittest

import rosbag
import yaml

from align_test_case import BALL_SI, SOURCE_ROOT, AlignTestCase

COLUMNS = (
    "t,x,y,phi,vx,vy,omega,n1,n2,t1,t2,nb1,nb2,tb1,tb2,nf1,nf2,tf1,tf2,event".split(",")
)


class CsvTest(AlignTestCase):
    def record(self, *arguments):
        """Returns the report and the rows, as dictionaries of floats."""
        path = self.path("run.csv")
        report = self.trial(self.scene(), "--csv", path, *arguments)
        with open(path) as file:
            reader = csv.DictReader(file)
            rows = [{key: float(value) for key, value in row.items()} for row in reader]
        self.assertEqual(reader.fieldnames, COLUMNS)
        return report, rows

    def test_starts_at_zero_and_ends_at_the_end(self):
        report, rows = self.record("--sample", "0.1")
        self.assertEqual(rows[0]["t"], 0.0)
        for key, value in report["final"].items():
            self.assertEqual(rows[-1][key], value, key)

    def test_time_never_runs_backwards(self):
        _, rows = self.record("--sample", "0.01")
        for before, after in zip(rows, rows[1:]):
            self.assertLessEqual(before["t"], after["t"])

    def test_regular_rows_lie_at_multiples_of_the_interval(self):
        _, rows = self.record("--sample", "0.1")
        regular = [row["t"] for row in rows[:-1] if row["event"] == 0]
        self.assertGreater(len(regular), 20)
        for index, t in enumerate(regular):
            self.assertAlmostEqual(t, 0.1 * index, delta=1e-14)

    def test_has_rows_at_event_instants(self):
        report, rows = self.record("--sample", "0.1")
        self.assertGreater(report["solver"]["events"], 0)
        self.assertGreater(sum(row["event"] for row in rows), 0)

    def test_regular_rows_do_not_depend_on_the_interval(self):
        _, coarse = self.record("--sample", "0.5")
        _, fine = self.record("--sample", "0.25")
        fine_by_time = {row["t"]: row for row in fine if row["event"] == 0}
        for row in coarse:
            if row["event"] == 0:
                self.assertEqual(row, fine_by_time[row["t"]])

    def test_forces_are_pushes_and_friction_is_within_its_bound(self):
        _, rows = self.record("--sample", "0.005")
        self.assertGreater(max(row["n1"] for row in rows), 0.0)
        for row in rows:
            for normal, tangential in (("n1", "t1"), ("n2", "t2"), ("nb1", "tb1"), ("nb2", "tb2")):
                self.assertGreaterEqual(row[normal], 0.0)
                self.assertLessEqual(abs(row[tangential]), 0.2 * row[normal] * (1 + 1e-9) + 1e-12)

    def test_default_interval_resolves_the_excitation(self):
        report, rows = self.record()
        periods = report["final"]["t"] * 20.0 / (2.0 * 3.14159265)
        self.assertGreaterEqual(sum(row["event"] == 0 for row in rows), 19 * periods)

    def test_replaces_an_old_file(self):
        self.write("run.csv", "old")
        _, rows = self.record()
        self.assertGreater(len(rows), 1)
        self.assertEqual(sorted(os.listdir(self.directory)), ["run.csv", "small.yaml"])

    def test_goes_to_a_pipe(self):
        process = self.align("trial", self.scene(), "--json", "--csv", "/dev/stderr", "--sample", "1")
        self.assertEqual(process.returncode, 0)
        self.assertEqual(process.stderr.splitlines()[0], ",".join(COLUMNS))


    def test_leaves_the_report_to_stderr_when_it_is_stdout(self):
        process = self.align("trial", self.scene(), "--csv", "/dev/stdout", "--sample", "1")
        self.assertEqual(process.returncode, 0)
        lines = process.stdout.splitlines()
        self.assertEqual(lines[0], ",".join(COLUMNS))
        self.assertEqual({line.count(",") for line in lines}, {len(COLUMNS) - 1})
        self.assertIn("Outcome", process.stderr)
        self.assert_refused(["trial", self.scene(), "--json", "--csv", "/dev/stdout"], "--json", "--csv")

    def test_alone_asks_for_samples(self):
        arguments = ["trial", self.scene(), "--sample", "1e-12"]
        self.assertEqual(self.align(*arguments).returncode, 0)
        self.assert_refused(arguments + ["--csv", "run.csv"], "--sample", "1e9 samples")

    def rows_of(self, scene, *arguments):
        """The report of a trial of the scene and its rows, as dictionaries of floats."""
        report = self.trial(scene, "--csv", "run.csv", *arguments)
        with open(self.path("run.csv")) as file:
            return report, [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def test_a_full_disk_is_told_at_the_end_too(self):
        # a few rows, all in a buffer until the file is closed, and files that end at 128 bytes
        def end_files_at_128_bytes():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (128, 128))
        in_the_air = self.scene(initial={"x": 0.2, "y": 5.0, "phi": 0.0})
        process = self.align("trial", in_the_air, "--csv", "run.csv", "--sample", "0.02", "--until", "0.1",
                             preexec_fn=end_files_at_128_bytes)
        self.assertEqual(process.returncode, 1)
        self.assertIn("run.csv: cannot be written: File too large", process.stderr)
        self.assertEqual(os.listdir(self.directory), ["small.yaml"])

    def test_is_in_si_units(self):
        # half a swing of the base takes 0.16 ms
        report, rows = self.rows_of(self.write("ball.yaml", yaml.safe_dump(BALL_SI)), "--sample", "1e-6")
        for key, value in report["final"].items():
            self.assertEqual(rows[-1][key], value, key)
        peak = report["peak_force"]["a1"]
        self.assertAlmostEqual(max(row["n1"] for row in rows), peak, delta=1e-3 * peak)
        # it slides to the right: friction pulls it to the left
        self.assertAlmostEqual(min(row["t1"] for row in rows), -0.1 * peak, delta=1e-3 * peak)
        self.assertLess(max(row["t1"] for row in rows), 1e-12 * peak)
        for column in ("n2", "t2", "nb1", "nb2", "tb1", "tb2", "nf1", "nf2", "tf1", "tf2"):
            self.assertEqual({row[column] for row in rows}, {0.0}, column)

    def test_corners_have_their_own_columns(self):
        # turned to the left, and held so, a part comes down on its left corner: b2; on the top surface, beside the slot,
        # or on the floor in it
        part = {"half_width": 0.7, "base_distance": 0.9}
        excitation = {"amplitude": 0.0, "frequency": 20.0}
        for phi, corner, other in ((0.01, "b2", "b1"), (-0.01, "b1", "b2")):
            aside = {"x": -0.5 if phi > 0 else 0.5, "y": 0.96, "phi": phi}
            top = self.scene("top.yaml", part=part, contacts=["corners"], excitation=excitation, initial=aside,
                             gripper={"damping": {"y": 0.5}, "anchor": {"y": 0.8}})
            floor = self.scene("floor.yaml", part=part, contacts=["walls"], excitation=excitation,
                               slot={"clearance": 0.09, "depth": 0.3}, initial={"x": 0.0, "y": 0.7, "phi": phi},
                               gripper={"damping": {"y": 0.5}, "anchor": {"y": 0.4}})
            for name, path in (("nb", top), ("nf", floor)):
                with self.subTest(corner=corner, column=name):
                    report, rows = self.rows_of(path, "--sample", "1e-3", "--until", "1.2")
                    self.assertGreater(report["impacts"][corner], 0)
                    self.assertEqual(report["impacts"][other], 0)
                    self.assertGreater(max(row[name + corner[1]] for row in rows), 0.0)
                    self.assertEqual(max(row[name + other[1]] for row in rows), 0.0)

    def test_is_not_the_file_that_the_report_goes_to(self):
        for name in ("/dev/stdout", "out.txt"):
            self.write("out.txt", "before\n")
            with self.subTest(name), open(self.path("out.txt"), "a") as out:
                process = self.align("trial", self.scene(), "--csv", name, stdout=out)
                self.assertEqual(process.returncode, 2)
                self.assertIn("--csv: %s: cannot be written" % name, process.stderr)
                with open(self.path("out.txt")) as file:
                    self.assertEqual(file.read(), "before\n")

    def test_is_not_the_file_that_messages_go_to(self):
        self.write("messages.txt", "before\n")
        command = [self.align_path, "trial", self.scene(), "--csv", "messages.txt"]
        with open(self.path("messages.txt"), "a") as messages:
            process = subprocess.run(command, cwd=self.directory, stdout=subprocess.PIPE, stderr=messages, timeout=60)
        self.assertEqual(process.returncode, 2)
        with open(self.path("messages.txt")) as file:
            self.assertRegex(file.read(), r"\Abefore\n.*--csv: messages.txt: cannot be written")

    def test_has_a_name(self):
        # what a shell makes of a variable that is not set
        for command, options in {
            "trial": ("--csv", "--bag"),
            "accuracy": ("--csv", "--plot"),
            "sweep": ("--csv",),
            "calibrate": ("--report", "--log"),
            "reproduce": ("--output", "--facts"),
        }.items():
            for option in options:
                with self.subTest(command + " " + option):
                    self.assert_refused([command, self.scene(), option, ""], option, "empty")


class PlaceTest(AlignTestCase):
    def test_a_new_file_has_the_rights_of_the_old_one(self):
        for command in (["trial", self.scene(), "--csv", "out.csv"], ["trial", self.scene(), "--bag", "out.bag"]):
            path = self.path(command[-1])
            open(path, "w").close()
            os.chmod(path, 0o600)
            self.assertEqual(self.align(*command).returncode, 0)
            self.assertEqual(os.stat(path).st_mode & 0o777, 0o600)
            self.assertGreater(os.path.getsize(path), 100)

    def test_goes_to_where_a_link_leads_also_where_nothing_is_yet(self):
        os.makedirs(self.path("sub"))
        os.symlink("sub/new.csv", self.path("link.csv"))
        os.symlink("link.csv", self.path("chain.csv"))
        for _ in range(2):
            self.assertEqual(self.align("trial", self.scene(), "--csv", "chain.csv").returncode, 0)
            self.assertTrue(os.path.islink(self.path("link.csv")) and os.path.islink(self.path("chain.csv")))
            self.assertGreater(os.path.getsize(self.path("sub/new.csv")), 100)
        os.symlink("loop", self.path("loop"))
        self.assert_refused(["trial", self.scene(), "--csv", "loop"], "--csv", "loop", "symbolic links")


class TerminalTest(AlignTestCase):
    """Of a run that takes longer than the second after which the bar is drawn."""

    def test_shows_how_far_the_run_is(self):
        seen = self.seen("trial", self.scene(), "--until", "1e6", until=b"at t = ")
        self.assertRegex(seen, rb"\r\x1b\[K\[[#.]+\] +\d+ %  at t = ")

    def test_shows_it_in_the_unit_of_the_scene(self):
        scene = os.path.join(SOURCE_ROOT, "config/scenes/gripper_si.yaml")
        words = b" of at most 12345,"
        self.assertIn(words, self.seen("trial", scene, "--until", "12345", until=words))

    def test_has_no_bar_among_the_rows(self):
        seen = self.seen("trial", self.scene(), "--until", "1e6", "--csv", "/dev/stdout", "--sample", "100")
        self.assertTrue(seen.startswith(b"t,x,y"))
        self.assertNotIn(b"\x1b", seen)


class LostFileTest(AlignTestCase):
    def test_full_disk(self):
        for option in ("--csv", "--bag"):
            with self.subTest(option):
                process = self.align("trial", self.scene(), option, "/dev/full", "--sample", "0.01")
                self.assertEqual(process.returncode, 1)
                self.assertIn("/dev/full", process.stderr)
                self.assertEqual(process.stdout, "")

    def test_full_disk_names_the_reason(self):
        process = self.align("trial", self.scene(), "--csv", "/dev/full")
        self.assertIn("No space left on device", process.stderr)

    def begin_endless(self, *arguments, command=(), sample="0.01"):
        """A trial that runs until it is ended; its files have been begun when this returns."""
        before = len(os.listdir(self.directory))
        process = subprocess.Popen(
            list(command) + [self.align_path, "trial", "small.yaml", "--until", "1e6", "--sample", sample]
            + list(arguments), cwd=self.directory, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while process.poll() is None and len(os.listdir(self.directory)) == before:
            self.assertLess(time.monotonic(), deadline, "no file is begun")
            time.sleep(0.01)
        return process

    def text_of(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def test_interrupted_run_leaves_no_file_and_keeps_the_old_one(self):
        self.scene()
        self.write("run.csv", "old")
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                process = self.begin_endless("--csv", "run.csv", "--bag", "run.bag")
                process.send_signal(number)
                stdout, stderr = process.communicate(timeout=30)
                self.assertEqual(process.returncode, 128 + number)
                self.assertEqual(stdout, b"")
                self.assertIn(b"interrupted", stderr)
                self.assertEqual(sorted(os.listdir(self.directory)), ["run.csv", "small.yaml"])
                self.assertEqual(self.text_of("run.csv"), "old")

    # As `timeout` sends one to the process and one to its group. Once all is tidied up the second one may end it.
    def test_an_interrupt_that_comes_twice_leaves_no_file(self):
        self.scene()
        for _ in range(10):
            process = self.begin_endless("--csv", "run.csv", "--bag", "run.bag")
            process.send_signal(signal.SIGINT)
            time.sleep(0.001)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=30)
            self.assertIn(process.returncode, (128 + signal.SIGINT, -signal.SIGINT))
            self.assertEqual(os.listdir(self.directory), ["small.yaml"])

    def test_an_interrupt_does_not_wait_for_the_next_sample(self):
        self.scene(excitation={"amplitude": 0.0, "frequency": 20.0}, initial={"x": 0.2, "y": 5.0},
                   solver={"step_limit": 10**12})
        process = self.begin_endless("--csv", "run.csv", "--solver", "rk4", "--step", "1e-9", sample="1e4")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)
        self.assertEqual(process.returncode, 128 + signal.SIGINT)

    def test_a_closed_stdout_leaves_nothing_unfinished(self):
        self.scene()
        for arguments, files in ((["--csv", "/dev/stdout", "--bag", "run.bag"], ["small.yaml"]),
                                 (["--csv", "run.csv"], ["run.csv", "small.yaml"])):
            read_end, write_end = os.pipe()
            os.close(read_end)
            process = self.align("trial", "small.yaml", *arguments, stdout=write_end)
            os.close(write_end)
            self.assertEqual((process.returncode, process.stderr), (-signal.SIGPIPE, ""))
            self.assertEqual(sorted(os.listdir(self.directory)), files)

    def test_a_run_under_nohup_outlives_its_terminal(self):
        self.scene()
        process = self.begin_endless("--csv", "run.csv", command=["nohup"])
        process.send_signal(signal.SIGHUP)
        with self.assertRaises(subprocess.TimeoutExpired):
            process.wait(timeout=0.5)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=30)
        self.assertEqual(process.returncode, 128 + signal.SIGTERM)

    def test_what_else_is_called_like_an_unfinished_file_stays(self):
        for name in ("run.csv.part", "run.bag.part"):
            self.write(name, "mine")
        for scene in (self.scene(), self.scene("fails.yaml", solver={"step_limit": 10})):
            self.align("trial", scene, "--csv", "run.csv", "--bag", "run.bag")
            for name in ("run.csv.part", "run.bag.part"):
                self.assertEqual(self.text_of(name), "mine")
        self.assertTrue(self.text_of("run.csv").startswith("t,x,y"))

    def test_two_runs_at_a_time_make_whole_files(self):
        self.scene()
        alone = self.align("trial", "small.yaml", "--csv", "alone.csv", "--sample", "1e-3", "--until", "2")
        self.assertEqual(alone.returncode, 0, alone.stderr)
        endless = self.begin_endless("--csv", "run.csv")
        other = self.align("trial", "small.yaml", "--csv", "run.csv", "--sample", "1e-3", "--until", "2")
        self.assertEqual(other.returncode, 0, other.stderr)
        endless.terminate()
        endless.communicate(timeout=30)
        self.assertEqual(self.text_of("run.csv"), self.text_of("alone.csv"))
        self.assertEqual(sorted(os.listdir(self.directory)), ["alone.csv", "run.csv", "small.yaml"])

    def test_a_file_has_the_rights_that_the_umask_leaves(self):
        for mask, rights in ((0o022, 0o644), (0o077, 0o600)):
            process = self.align("trial", self.scene(), "--csv", "run.csv", preexec_fn=lambda: os.umask(mask))
            self.assertEqual(process.returncode, 0, process.stderr)
            self.assertEqual(os.stat(self.path("run.csv")).st_mode & 0o777, rights)
            os.remove(self.path("run.csv"))

    def test_names_the_file_that_cannot_be_made(self):
        name = "n" * 250 + ".csv"  # a name as long as there can be, and none longer
        message = self.assert_refused(["trial", self.scene(), "--csv", name], "--csv: " + name, "File name too long")
        self.assertRegex(message, name + r"\.\d+\.part: File name too long")

    def test_failed_run_leaves_no_file_and_keeps_the_old_ones(self):
        path = self.scene(solver={"step_limit": 10})
        for name in ("run.csv", "run.bag"):
            self.write(name, "old")
        process = self.align("trial", path, "--csv", "run.csv", "--bag", "run.bag", "--json")
        self.assertEqual(process.returncode, 1)
        self.assertEqual(json.loads(process.stdout)["outcome"], "failed")
        self.assertIn("it leaves no file", process.stderr)
        self.assertEqual(sorted(os.listdir(self.directory)), ["run.bag", "run.csv", "small.yaml"])
        for name in ("run.csv", "run.bag"):
            with open(self.path(name)) as file:
                self.assertEqual(file.read(), "old")

    def test_failed_run_sends_its_rows_to_a_pipe(self):
        process = self.align("trial", self.scene(solver={"step_limit": 10}), "--csv", "/dev/stdout")
        self.assertEqual(process.returncode, 1)
        self.assertEqual(process.stdout.splitlines()[0], ",".join(COLUMNS))


class BagTest(AlignTestCase):
    def record(self, *arguments):
        path = self.path("run.bag")
        scales = {"mass": 0.1, "stiffness": 4000.0, "force": 8.0}
        report = self.trial(self.scene(scales=scales), "--bag", path, *arguments)
        with rosbag.Bag(path) as bag:
            return report, list(bag.read_messages())

    def test_is_whole_and_has_the_topics_of_the_node(self):
        _, messages = self.record("--sample", "0.1")
        topics = {message.topic for message in messages}
        node = {"/aligner/" + name for name in ("state", "reaction/a1", "reaction/a2", "contacts", "markers", "result")}
        self.assertLessEqual(node | {"/tf", "/tf_static"}, topics)
        self.assertEqual(sum(message.topic == "/aligner/result" for message in messages), 1)

    def test_stamps_grow_and_are_never_zero(self):
        _, messages = self.record("--sample", "0.1")
        stamps = [message.message.header.stamp.to_sec() for message in messages if message.topic == "/aligner/state"]
        self.assertGreater(len(stamps), 20)
        self.assertGreater(stamps[0], 0.0)
        for before, after in zip(stamps, stamps[1:]):
            self.assertLess(before, after)

    def test_changes_nothing_in_the_motion(self):
        report, _ = self.record("--sample", "0.1")
        self.assertEqual(report["final"], self.trial(self.scene())["final"])

    def test_replaces_an_old_file(self):
        self.write("run.bag", "old")
        self.record()
        self.assertEqual(sorted(os.listdir(self.directory)), ["run.bag", "small.yaml"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
