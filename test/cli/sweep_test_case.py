"""What the tests of `align sweep` and `align merge` share."""

import csv

import yaml

from align_test_case import AlignTestCase

# Over SMALL_SCENE of align_test_case.py: short trials, of which a part aligns in some.
SMALL_STUDY = {
    "scene": "small.yaml",
    "set": {"trial.time_limit": 1.5},
    "vary": [
        {"gripper.pressing_force": {"from": 0.1, "to": 0.8, "count": 5}},
        {"initial.x": [0.1, 0.2], "excitation.frequency": [20, 25]},
        {"excitation.phase": {"from": 0, "to": 6.25}},
    ],
    "samples": {"count": 4, "seed": 1},
}
SMALL_STUDY_TRIALS = 5 * 2 * 4


class SweepTestCase(AlignTestCase):
    def setUp(self):
        super().setUp()
        self.scene()

    def study(self, name="study.yaml", without=(), **changes):
        """Writes SMALL_STUDY with other sections, or without some; returns the path."""
        tree = dict(SMALL_STUDY, **changes)
        for key in without:
            del tree[key]
        return self.write(name, yaml.safe_dump(tree, sort_keys=False))

    def sweep(self, *arguments, **options):
        """Runs `align sweep ...`, which must succeed; returns what it prints."""
        process = self.align("sweep", *arguments, **options)
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual(process.stderr, "")
        return process.stdout

    def bytes_of(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def rows(self, name):
        """The rows of a sweep's file, as dictionaries of text."""
        with open(self.path(name), newline="") as file:
            self.assertTrue(file.readline().startswith("# align sweep "))
            return list(csv.DictReader(file))
