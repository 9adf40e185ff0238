"""`align sweep --shard` and `align merge`: the shards of a sweep make the file of the whole one, and nothing else does."""

import os
import signal
import subprocess
import time
import unittest

from sweep_test_case import SMALL_STUDY_TRIALS, SweepTestCase


class MergeTest(SweepTestCase):
    def shards(self, count, study="study.yaml", prefix=""):
        names = []
        for number in range(1, count + 1):
            names.append("%s%d_%d.csv" % (prefix, number, count))
            self.sweep(study, "--csv", names[-1], "--shard", "%d/%d" % (number, count))
        return names

    def setUp(self):
        super().setUp()
        self.study()

    def test_shards_make_the_whole_file(self):
        self.sweep("study.yaml", "--csv", "whole.csv")
        for count in (1, 3, SMALL_STUDY_TRIALS + 2):
            names = self.shards(count)
            process = self.align("merge", "out.csv", *reversed(names))
            self.assertEqual(process.returncode, 0, process.stderr)
            self.assertEqual(self.bytes_of("out.csv"), self.bytes_of("whole.csv"))
        # the merged file passes for the whole sweep
        self.assertIn("0 trials in", self.sweep("study.yaml", "--csv", "out.csv", "--resume"))

    def test_rows_alone_go_to_stdout(self):
        self.sweep("study.yaml", "--csv", "whole.csv")
        process = self.align("merge", "/dev/stdout", *self.shards(2))
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual(process.stdout, self.bytes_of("whole.csv").decode())
        self.assertEqual(process.stderr, "%d trials of 2 shards\n" % SMALL_STUDY_TRIALS)

    def test_a_shard_has_its_trials_alone(self):
        self.sweep("study.yaml", "--csv", "out.csv", "--shard", "2/3")
        self.assertEqual([int(row["trial"]) for row in self.rows("out.csv")], list(range(1, SMALL_STUDY_TRIALS, 3)))

    def test_a_shard_can_be_continued(self):
        names = self.shards(3)
        whole = self.bytes_of(names[1])
        os.remove(self.path(names[1]))
        self.write(names[1] + ".part", whole[: len(whole) // 2])
        self.sweep("study.yaml", "--csv", names[1], "--shard", "2/3", "--resume")
        self.assertEqual(self.bytes_of(names[1]), whole)

    def assert_no_merge(self, names, *words):
        self.assert_refused(["merge", "out.csv"] + names, *words)
        self.assertFalse(os.path.exists(self.path("out.csv")))
        self.assertEqual([name for name in os.listdir(self.directory) if name.endswith(".part")], [])

    def test_what_is_wrong_with_the_shards_is_told_by_name(self):
        names = self.shards(3)
        self.assert_no_merge([names[0], names[2]], "missing: shard 2/3")
        self.assert_no_merge([names[0], "nowhere.csv"], "nowhere.csv: cannot be read: No such file")
        self.assert_no_merge([names[0], "."], ".: cannot be read: Is a directory")
        self.assert_no_merge([names[1]], "missing: shard 1/3, 3/3")
        self.write("copy.csv", self.bytes_of(names[1]))
        self.assert_no_merge(names + ["copy.csv"], "copy.csv: is shard 2/3", names[1])
        self.assert_no_merge([names[0], names[1], "nosuch.csv"], "nosuch.csv", "No such file")
        self.assert_no_merge([names[0], names[1], "small.yaml"], "small.yaml: is no file of `align sweep")
        self.study("other.yaml", samples={"count": 4, "seed": 2})
        other = self.shards(3, "other.yaml", "other")
        self.assert_no_merge([names[0], names[1], other[2]], other[2] + ": is of another sweep")
        halves = self.shards(2)
        self.assert_no_merge([names[0], names[1], halves[0]], halves[0] + ": is shard 1/2")

    def test_shards_that_are_not_whole_are_told_by_name(self):
        names = self.shards(3)
        whole = self.bytes_of(names[1])
        lines = whole.split(b"\n")
        self.write(names[1], b"\n".join(lines[:-2]) + b"\n")
        self.assert_no_merge(names, names[1] + ": ends before trial", "--resume")
        self.write(names[1], whole[:-1])
        self.assert_no_merge(names, names[1] + ": ends before trial")
        self.write(names[1], whole + lines[5] + b"\n")
        self.assert_no_merge(names, names[1] + ": has more lines")
        self.write(names[1], b"\n".join(lines[:4] + lines[5:]))
        self.assert_no_merge(names, names[1] + ": has another line")
        cells = lines[4].split(b",")
        for row, count in ((cells[:-3], len(cells) - 3), (cells + [b""], len(cells) + 1)):
            self.write(names[1], b"\n".join(lines[:4] + [b",".join(row)] + lines[5:]))
            self.assert_no_merge(names, "%s: line 5 has %d cells, not %d" % (names[1], count, len(cells)))

    def test_the_whole_file_has_a_name(self):
        self.assert_refused(["merge", ""] + self.shards(2), "OUT", "empty")

    def test_a_shard_is_not_overwritten(self):
        names = self.shards(2)
        before = self.bytes_of(names[0])
        self.assert_refused(["merge", names[0]] + names, names[0], "not overwritten")
        self.assertEqual(self.bytes_of(names[0]), before)

    def test_an_interrupt_leaves_no_file(self):
        names = self.shards(2)
        lines = self.bytes_of(names[1]).splitlines(keepends=True)
        os.remove(self.path(names[1]))
        os.mkfifo(self.path(names[1]))
        process = subprocess.Popen([self.align_path, "merge", "out.csv"] + names, cwd=self.directory,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(process.kill)
        before = len(os.listdir(self.directory))
        with open(self.path(names[1]), "wb", buffering=0) as shard:
            shard.write(b"".join(lines[:3]))
            while process.poll() is None and len(os.listdir(self.directory)) == before:
                time.sleep(0.01)
            process.send_signal(signal.SIGTERM)
            shard.write(lines[3])
            output, message = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 128 + signal.SIGTERM)
        self.assertEqual((output, message), ("", "align: interrupted; nothing is written\n"))
        self.assertEqual(len(os.listdir(self.directory)), before)

    def test_a_full_disk_is_told(self):
        process = self.align("merge", "/dev/full", *self.shards(2))
        self.assertEqual(process.returncode, 1)
        self.assertIn("/dev/full: cannot be written", process.stderr)


if __name__ == "__main__":
    unittest.main()
