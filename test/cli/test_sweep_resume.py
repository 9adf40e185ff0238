"""`align sweep --resume`: whatever ended a sweep, and wherever, the file that comes out is that of a sweep that ran through."""

import os
import random
import signal
import subprocess
import time
import unittest

from sweep_test_case import SMALL_STUDY_TRIALS, SweepTestCase


class ResumeTest(SweepTestCase):
    def setUp(self):
        super().setUp()
        self.study()
        self.sweep("study.yaml", "--csv", "whole.csv")
        self.whole = self.bytes_of("whole.csv")

    def resume(self, *arguments):
        return self.sweep("study.yaml", "--csv", "out.csv", "--resume", *arguments)

    def assert_resumes_from(self, part):
        if os.path.exists(self.path("out.csv")):
            os.remove(self.path("out.csv"))
        self.write("out.csv.part", part)
        self.resume()
        self.assertEqual(self.bytes_of("out.csv"), self.whole)
        self.assertFalse(os.path.exists(self.path("out.csv.part")))

    def test_begins_where_there_is_nothing(self):
        self.resume()
        self.assertEqual(self.bytes_of("out.csv"), self.whole)

    def test_goes_on_from_every_kind_of_end(self):
        lines = self.whole.split(b"\n")
        head = len(lines[0]) + 1
        columns = head + len(lines[1]) + 1
        cuts = [0, 1, head - 1, head, head + 1, columns - 1, columns, columns + 1, len(self.whole) - 1, len(self.whole)]
        cuts += random.Random(1).sample(range(columns, len(self.whole)), 15)
        for cut in cuts:
            with self.subTest(cut=cut):
                self.assert_resumes_from(self.whole[:cut])

    def test_runs_only_what_is_missing(self):
        lines = self.whole.split(b"\n")
        self.write("out.csv.part", b"\n".join(lines[: 2 + 30]) + b"\n" + lines[32][:9])
        text = self.resume()
        self.assertIn("%d trials in" % (SMALL_STUDY_TRIALS - 30), text)
        # the summary is that of all trials, also of those that ran before
        everything = self.sweep("study.yaml")
        self.assertEqual(text.split("Run ")[0], everything.split("Run ")[0])

    def test_with_other_threads_is_the_same(self):
        self.write("out.csv.part", self.whole[: len(self.whole) // 3])
        self.resume("--threads", "3")
        self.assertEqual(self.bytes_of("out.csv"), self.whole)

    def test_a_whole_file_is_left_alone(self):
        self.resume()
        before = os.stat(self.path("out.csv"))
        text = self.resume()
        after = os.stat(self.path("out.csv"))
        self.assertEqual((before.st_mtime_ns, before.st_ino), (after.st_mtime_ns, after.st_ino))
        self.assertIn("0 trials in", text)
        self.assertFalse(os.path.exists(self.path("out.csv.part")))

    def test_of_another_study_is_refused(self):
        part = self.whole[: len(self.whole) // 2]
        changes = {
            "vary": lambda: self.study(samples={"count": 4, "seed": 2}),
            "set": lambda: self.study(set={"trial.time_limit": 1.6}),
            "scene": lambda: self.scene(friction={"coefficient": 0.21}),
        }
        for name, change in changes.items():
            for file in ("out.csv.part", "out.csv"):
                with self.subTest(change=name, file=file):
                    self.scene()
                    self.study()
                    self.write(file, part)
                    change()
                    self.assert_refused(["sweep", "study.yaml", "--csv", "out.csv", "--resume"], file, "another study")
                    self.assertEqual(self.bytes_of(file), part)
                    os.remove(self.path(file))
        self.scene()
        self.study()
        self.write("out.csv.part", part)
        self.assert_refused(
            ["sweep", "study.yaml", "--csv", "out.csv", "--resume", "--shard", "1/2"], "out.csv.part", "shard"
        )

    def test_comments_in_study_and_scene_do_not_matter(self):
        with open(self.path("study.yaml"), "a") as file:
            file.write("# a comment\n")
        with open(self.path("small.yaml"), "a") as file:
            file.write("# a comment\n")
        self.assert_resumes_from(self.whole[: len(self.whole) // 2])

    def test_a_file_that_was_changed_is_refused(self):
        lines = self.whole.split(b"\n")
        for changed in (lines[:10] + lines[11:20], lines[:10] + [lines[5]] + lines[10:20], lines[:-1] + lines[5:6]):
            self.write("out.csv.part", b"\n".join(changed) + b"\n")
            self.assert_refused(
                ["sweep", "study.yaml", "--csv", "out.csv", "--resume"], "out.csv.part", "line", "was changed"
            )

    def test_a_line_without_all_of_its_cells_is_refused(self):
        lines = self.whole.split(b"\n")
        cells = lines[9].split(b",")
        part = b"\n".join(lines[:9] + [b",".join(cells[:3])] + lines[10:])
        for name in ("out.csv.part", "out.csv"):
            self.write(name, part)
            self.assert_refused(["sweep", "study.yaml", "--csv", "out.csv", "--resume"],
                                name + ": line 10 has 3 cells, not %d" % len(cells))
            self.assertEqual(self.bytes_of(name), part)
            os.remove(self.path(name))

    def test_a_file_that_is_not_whole_does_not_pass_for_whole(self):
        lines = self.whole.split(b"\n")
        part = b"\n".join(lines[:12]) + b"\n"
        self.write("out.csv", part)
        self.assert_refused(["sweep", "study.yaml", "--csv", "out.csv", "--resume"], "out.csv", "is not whole")
        self.assertEqual(self.bytes_of("out.csv"), part)

    def test_another_file_is_refused_and_kept(self):
        self.write("out.csv", "my notes\n")
        self.assert_refused(["sweep", "study.yaml", "--csv", "out.csv", "--resume"], "out.csv", "cannot be continued")
        self.assertEqual(self.bytes_of("out.csv"), b"my notes\n")
        self.assertFalse(os.path.exists(self.path("out.csv.part")))

    def test_rows_that_cannot_be_read_are_not_lost(self):
        nobody = 65534
        preexec = None if os.geteuid() != 0 else lambda: (os.setgid(nobody), os.setuid(nobody))
        try:
            may_run = self.align("--version", preexec_fn=preexec).returncode == 0
        except (OSError, subprocess.SubprocessError):
            may_run = False
        if not may_run:
            self.skipTest("another user may not run align here")
        part = self.whole[: len(self.whole) // 2]
        self.write("out.csv.part", part)
        os.chmod(self.directory, 0o777)
        os.chmod(self.path("out.csv.part"), 0o222)
        for resume in (["--resume"], []):
            process = self.align("sweep", "study.yaml", "--csv", "out.csv", *resume, preexec_fn=preexec)
            self.assertEqual(process.returncode, 2)
            self.assertIn("--csv: out.csv.part: cannot be read: Permission denied", process.stderr)
        os.chmod(self.path("out.csv.part"), 0o600)
        self.assertEqual(self.bytes_of("out.csv.part"), part)

    def test_without_it_rows_are_not_lost(self):
        part = self.whole[: len(self.whole) // 2]
        self.write("out.csv.part", part)
        self.assert_refused(["sweep", "study.yaml", "--csv", "out.csv"], "out.csv.part", "--resume")
        self.assertEqual(self.bytes_of("out.csv.part"), part)

    def test_without_it_an_old_file_is_replaced_at_the_end(self):
        self.write("out.csv", "old")
        self.sweep("study.yaml", "--csv", "out.csv")
        self.assertEqual(self.bytes_of("out.csv"), self.whole)


class LongSweepTest(SweepTestCase):
    """A sweep of some seconds, to be ended on the way."""

    def setUp(self):
        super().setUp()
        self.study(samples={"count": 200, "seed": 1})

    def start(self, *arguments):
        return subprocess.Popen(
            [self.align_path, "sweep", "study.yaml", "--csv", "out.csv"] + list(arguments),
            cwd=self.directory,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            universal_newlines=True,
        )

    def wait_for_rows(self, process, bytes_more):
        """Until the file has grown by so much; the sweep must not be through by then."""
        path = self.path("out.csv.part")
        begin = os.path.getsize(path) if os.path.exists(path) else 0
        for _ in range(6000):
            self.assertIsNone(process.poll(), "the sweep is too short for this test")
            if os.path.exists(path) and os.path.getsize(path) > begin + bytes_more:
                return
            time.sleep(0.005)
        self.fail("no rows come")

    def assert_ends_as_one_run(self):
        self.sweep("study.yaml", "--csv", "out.csv", "--resume")
        self.sweep("study.yaml", "--csv", "whole.csv")
        self.assertEqual(self.bytes_of("out.csv"), self.bytes_of("whole.csv"))

    def test_killed_again_and_again(self):
        for round_number in range(4):
            process = self.start("--resume")
            self.wait_for_rows(process, 20000 + 7001 * round_number)
            process.kill()
            process.communicate()
            self.assertFalse(os.path.exists(self.path("out.csv")))
        self.assert_ends_as_one_run()

    def test_interrupted(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            process = self.start("--resume")
            self.wait_for_rows(process, 20000)
            process.send_signal(number)
            output, message = process.communicate(timeout=20)
            self.assertEqual(process.returncode, 128 + number)
            self.assertEqual(output, "")
            self.assertRegex(message, r"interrupted after \d+ of 2000 trials; \S*out.csv.part .*--resume")
            self.assertTrue(self.bytes_of("out.csv.part").endswith(b"\n"))
        self.assert_ends_as_one_run()

    def test_rows_are_there_as_soon_as_their_trials_have_ended(self):
        # two short trials, and one that would take hours
        self.study(set={"solver": {"name": "rk4", "step": 1e-9, "step_limit": 10**15}},
                   vary=[{"trial.time_limit": [1e-6, 1e-6, 3.0]}], without=["samples"])
        process = self.start("--threads", "1")
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 20
        while time.monotonic() < deadline:
            if os.path.exists(self.path("out.csv.part")) and self.bytes_of("out.csv.part").count(b"\n") == 4:
                return
            time.sleep(0.01)
        self.fail("no rows come")

    def test_has_no_bar_among_the_rows_on_a_terminal(self):
        self.study(samples={"count": 100000, "seed": 1})
        self.assertIn(b"\x1b[K[", self.seen("sweep", "study.yaml", until=b"\x1b[K["))
        self.assertNotIn(b"\x1b", self.seen("sweep", "study.yaml", "--csv", "/dev/stdout"))

    def test_two_at_a_time_are_refused(self):
        process = self.start()
        self.wait_for_rows(process, 1000)
        self.assert_refused(["sweep", "study.yaml", "--csv", "out.csv", "--resume"], "out.csv.part", "another")
        process.kill()
        process.communicate()


if __name__ == "__main__":
    unittest.main()
