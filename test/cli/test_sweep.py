"""`align sweep`: the table that it writes, what it says, what it refuses."""

import os
import resource
import statistics
import unittest

from sweep_test_case import SMALL_STUDY_TRIALS, SweepTestCase

SPOTS = ("a1", "a2", "b1", "b2")


class TableTest(SweepTestCase):
    def test_has_a_row_for_every_trial_in_order(self):
        self.sweep(self.study(), "--csv", "out.csv")
        rows = self.rows("out.csv")
        self.assertEqual([int(row["trial"]) for row in rows], list(range(SMALL_STUDY_TRIALS)))
        self.assertEqual(sorted(os.listdir(self.directory)), ["out.csv", "small.yaml", "study.yaml"])

    def test_columns_begin_with_what_is_varied(self):
        self.sweep(self.study(), "--csv", "out.csv")
        columns = list(self.rows("out.csv")[0])
        self.assertEqual(
            columns[:6],
            ["trial", "gripper.pressing_force", "initial.x", "excitation.frequency", "excitation.phase", "outcome"],
        )
        self.assertEqual(columns[-1], "reason")

    def test_every_row_is_the_trial_of_its_values(self):
        """`align trial` with the values of a row gives the row's results, to the last digit."""
        self.sweep(self.study(), "--csv", "out.csv")
        rows = self.rows("out.csv")
        outcomes = set()
        for row in rows[::5]:
            settings = ["--set", "trial.time_limit=1.5"]
            for key in ("gripper.pressing_force", "initial.x", "excitation.frequency", "excitation.phase"):
                settings += ["--set", key + "=" + row[key]]
            report = self.trial("small.yaml", *settings)
            outcomes.add(report["outcome"])
            self.assertEqual(row["outcome"], report["outcome"])
            self.assertEqual(row["mode"], report["mode"])
            self.assertEqual(float(row["duration"] or "nan") == report["duration"], report["duration"] is not None)
            self.assertEqual(float(row["end_time"]), report["final"]["t"])
            for key in ("x", "y", "phi", "vx", "vy", "omega"):
                self.assertEqual(float(row[key]), report["final"][key])
            for spot in SPOTS:
                self.assertEqual(int(row["impacts_" + spot]), report["impacts"][spot])
                self.assertEqual(float(row["peak_force_" + spot]), report["peak_force"][spot])
                self.assertEqual(row["first_impact_" + spot] != "", report["impacts"][spot] > 0)
            first = report["first_contact"]
            if first:
                self.assertEqual(float(row["first_impact_" + first["at"]]), first["t"])
        self.assertGreater(len(outcomes), 1, "a study with one outcome shows little")

    def test_threads_change_no_byte(self):
        for threads in (1, 2, 5):
            self.sweep(self.study(), "--csv", "%d.csv" % threads, "--threads", threads)
        self.assertEqual(self.bytes_of("1.csv"), self.bytes_of("2.csv"))
        self.assertEqual(self.bytes_of("1.csv"), self.bytes_of("5.csv"))

    def test_values_that_hold_commas_are_quoted(self):
        study = self.study(vary=[{"contacts": [["edges"], ["edges", "corners"]]}], without=["samples"])
        self.sweep(study, "--csv", "out.csv")
        self.assertEqual([row["contacts"] for row in self.rows("out.csv")], ["[edges]", "[edges, corners]"])

    def test_offsets_have_columns_of_their_own(self):
        study = self.study(
            vary=[{"initial.x": [0.2, 0.3]}, {"initial.x": {"from": -0.01, "to": 0.01, "count": 3, "as": "offset"}}],
            without=["samples"],
        )
        self.sweep(study, "--csv", "out.csv")
        row = self.rows("out.csv")[3]
        self.assertEqual((row["initial.x"], row["initial.x offset"]), ("0.3", "-0.01"))
        report = self.trial("small.yaml", "--set", "trial.time_limit=1.5", "--set", "initial.x=0.29")
        self.assertAlmostEqual(float(row["x"]), report["final"]["x"], places=9)

    def test_refused_and_failed_trials_are_rows_with_a_reason(self):
        study = self.study(
            vary=[{"slot.clearance": [0.1, 0]}, {"solver.step_limit": [3, 1000000]}], without=["samples"]
        )
        text = self.sweep(study, "--csv", "out.csv")
        rows = self.rows("out.csv")
        self.assertEqual([row["outcome"] for row in rows[2:]], ["refused", "refused"])
        self.assertEqual(rows[0]["outcome"], "failed")
        self.assertNotIn(rows[1]["outcome"], ("failed", "refused"))
        self.assertIn("slot.clearance: 0: must be a number > 0", rows[2]["reason"])
        self.assertIn("step", rows[0]["reason"])
        self.assertEqual(rows[1]["reason"], "")
        self.assertEqual(rows[2]["end_time"], "")
        self.assertRegex(text, r"refused +2 +50.00 %\n +first: trial 2: slot.clearance: 0")

    def test_refused_trials_are_rows_wherever_they_stand(self):
        study = self.study(vary=[{"slot.clearance": [0, 0.1, 0, 0.12, 0]}], without=["samples"])
        self.sweep(study, "--csv", "out.csv")
        outcomes = [row["outcome"] == "refused" for row in self.rows("out.csv")]
        self.assertEqual(outcomes, [True, False, True, False, True])

    def test_null_is_fine_where_the_scene_has_no_such_key(self):
        solvers = {"solver.name": ["event", "rk4"], "solver.step": [None, 1e-3]}
        self.sweep(self.study(vary=[solvers], without=["samples"]), "--csv", "out.csv")
        self.assertEqual([(row["solver.step"], row["reason"]) for row in self.rows("out.csv")],
                         [("null", ""), ("0.001", "")])
        misspelt = self.study(vary=[{"solver.stepp": [None, 1e-3]}], without=["samples"])
        self.assert_refused(["sweep", misspelt], "no such key to take out", "did you mean solver.step?")

    def test_is_in_the_units_of_an_si_scene(self):
        study = self.study(
            scene="gripper_si", set={}, vary=[{"friction.coefficient": [0.15, 0.2]}], without=["samples"]
        )
        self.sweep(study, "--csv", "out.csv")
        report = self.trial("gripper_si")
        row = self.rows("out.csv")[0]
        self.assertEqual(float(row["end_time"]), report["final"]["t"])
        self.assertEqual(float(row["vx"]), report["final"]["vx"])
        self.assertEqual(float(row["peak_force_a1"]), report["peak_force"]["a1"])

    def test_settings_hold_for_all_trials(self):
        self.sweep(self.study(), "--csv", "a.csv", "--set", "trial.time_limit=0.5")
        self.assertTrue(all(float(row["end_time"]) <= 0.5 for row in self.rows("a.csv")))
        self.sweep("--set", "trial.time_limit=0.5", "friction.coefficient=0.3", self.study(), "--csv", "b.csv")
        self.sweep(self.study(set={"trial.time_limit": 0.5, "friction.coefficient": 0.3}), "--csv", "c.csv")
        self.assertEqual(self.rows("b.csv"), self.rows("c.csv"))

    def test_rows_alone_go_to_stdout(self):
        process = self.align("sweep", self.study(), "--csv", "/dev/stdout")
        self.assertEqual(process.returncode, 0)
        self.sweep(self.study(), "--csv", "out.csv")
        self.assertEqual(process.stdout, self.bytes_of("out.csv").decode())
        self.assertIn("Study", process.stderr)


class SummaryTest(SweepTestCase):
    def test_counts_the_outcomes_and_orders_the_durations(self):
        text = self.sweep(self.study(), "--csv", "out.csv")
        rows = self.rows("out.csv")
        for outcome in {row["outcome"] for row in rows}:
            count = sum(row["outcome"] == outcome for row in rows)
            self.assertRegex(text, r"(?m)^%s +%d +%.2f %%" % (outcome, count, 100.0 * count / len(rows)))
        durations = sorted(float(row["duration"]) for row in rows if row["duration"])
        words = text[text.index("duration") :].replace(",", " ").split()
        least, lower, middle, upper, greatest = (float(words[i]) for i in (2, 4, 5, 6, 8))
        self.assertEqual(["%.4g" % value for value in (least, greatest)],
                         ["%.4g" % value for value in (durations[0], durations[-1])])
        quartiles = statistics.quantiles(durations, n=4, method="inclusive")
        self.assertEqual(["%.4g" % value for value in (lower, middle, upper)], ["%.4g" % value for value in quartiles])

    def test_leaves_the_file_of_another_shard(self):
        study = self.study()
        self.sweep(study, "--csv", "out.csv", "--shard", "1/2")
        first = self.bytes_of("out.csv")
        for shard in (["--shard", "2/2"], ["--shard", "1/3"], []):
            self.assert_refused(["sweep", study, "--csv", "out.csv"] + shard, "has shard 1/2 of this study")
            self.assertEqual(self.bytes_of("out.csv"), first)
        # the same one again, and that of another study, are replaced as any older result
        self.sweep(study, "--csv", "out.csv", "--shard", "1/2")
        self.sweep(self.study(samples={"count": 2, "seed": 9}), "--csv", "out.csv", "--shard", "2/2")

    def summary_of_many_trials(self, first, apart):
        """What is said of a sweep of 100001 trials with these durations."""
        count = 100001
        study = self.study(vary=[{"initial.x": {"from": 0.1, "to": 0.2, "count": count}}], without=["samples"])
        self.sweep(study, "--csv", "out.csv", "--shard", "1/%d" % count)
        head, columns, row = self.bytes_of("out.csv").decode().splitlines()
        cells = row.split(",")
        cells[2], cells[4] = "aligned", "%.17g"
        row = ",".join(cells[1:])
        with open(self.path("out.csv"), "w") as file:
            file.write(head.split(", shard")[0] + "\n" + columns + "\n")
            for trial in range(count):
                file.write("%d," % trial + row % (first + apart * trial) + "\n")
        return self.sweep(study, "--csv", "out.csv", "--resume")

    def test_shows_the_digits_that_it_knows_of_many_trials(self):
        self.assertIn("duration     least 1.231, quartiles 1.23, 1.23, 1.23, greatest 1.232",
                      self.summary_of_many_trials(1.2314, 1e-8))

    def test_has_the_quartiles_of_many_trials(self):
        self.assertIn("duration     least 1, quartiles 1.25, 1.5, 1.75, greatest 2\n",
                      self.summary_of_many_trials(1.0, 1e-5))

    def test_counts_one_trial_as_one(self):
        text = self.sweep(self.study(without=["vary", "samples"]))
        self.assertIn("Study        study, 1 trial\n", text)
        self.assertRegex(text, r"Run          1 trial in ")

    def test_is_all_there_is_without_a_file(self):
        text = self.sweep(self.study())
        self.assertIn("%d trials" % SMALL_STUDY_TRIALS, text)
        self.assertEqual(sorted(os.listdir(self.directory)), ["small.yaml", "study.yaml"])

    def test_shipped_studies_run(self):
        directory = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "config", "studies")
        names = [os.path.splitext(name)[0] for name in sorted(os.listdir(directory)) if name.endswith(".yaml")]
        self.assertTrue(names)
        for name in names:
            # two trials of each are enough to see that it loads
            process = self.align("sweep", name, "--shard", "1/100000000000000")
            self.assertEqual(process.returncode, 0, name + process.stderr)


class RefusalTest(SweepTestCase):
    def test_faults_of_the_study(self):
        self.assert_refused(["sweep", self.study(vary={"initial.x": 3})], "the study is refused", "study.yaml", "vary.initial.x: 3")
        self.assert_refused(["sweep", self.study(without=["samples"])], "samples", "missing")
        self.assert_refused(["sweep", self.study(vary={"initial.x": [0.1, 0.2]})], "samples", "nothing is sampled")
        self.assert_refused(["sweep", self.study(vary={"initial.z": [3]}, without=["samples"])], "initial.z", "unknown key")
        self.assert_refused(["sweep", self.study(scene="nosuch")], "scene: nosuch", "fig2")
        self.assert_refused(["sweep", "nosuch"], "nosuch", "no such file")
        self.assert_refused(["sweep", self.directory], "directory")
        self.assert_refused(["sweep", self.study(), "--set", "initial.x.y=3"], "--set initial.x.y=3")
        self.assert_refused(["sweep", self.study(), "--set", "foo.bar=1"], "the study is refused", "foo", "unknown key",
                            "(set by foo.bar=1)")
        self.assert_refused(["sweep", self.study(set={"part.foo": 1})], "part.foo: 1: unknown key",
                            "(set by %s: set)" % self.path("study.yaml"))

    def test_what_is_varied_cannot_be_set(self):
        for value in ("0.3", "nonsense"):
            self.assert_refused(["sweep", self.study(), "--set", "initial.x=" + value], "--set initial.x=" + value,
                                "study.yaml varies initial.x")

    def test_faults_of_the_call(self):
        study = self.study()
        self.assert_refused(["sweep"], "STUDY")
        for shard in ("0/3", "4/3", "1", "a/b", "1/0", "-1/2"):
            self.assert_refused(["sweep", study, "--shard", shard], shard)
        for threads in ("0", "-1", "x"):
            self.assert_refused(["sweep", study, "--threads", threads], "--threads")
        self.assert_refused(["sweep", study, "--resume"], "--resume", "--csv")
        self.assert_refused(["sweep", study, "--csv", "/dev/null", "--resume"], "/dev/null")
        self.assert_refused(["sweep", study, "--csv", "nosuch/out.csv"], "nosuch/out.csv")

    def test_threads_that_cannot_be_had_are_told(self):
        def want_32_terabytes_each():
            resource.setrlimit(resource.RLIMIT_STACK, (1 << 45, resource.getrlimit(resource.RLIMIT_STACK)[1]))
        process = self.align("sweep", self.study(), "--threads", "8", preexec_fn=want_32_terabytes_each)
        self.assertEqual(process.returncode, 1)
        self.assertRegex(process.stderr, r"^align: cannot start thread \d: ")

    def test_what_is_no_file_is_in_the_way_of_the_rows(self):
        os.mkfifo(self.path("out.csv.part"))
        self.assert_refused(["sweep", self.study(), "--csv", "out.csv"], "out.csv.part", "in the way")

    def test_a_full_disk_is_told(self):
        process = self.align("sweep", self.study(), "--csv", "/dev/full")
        self.assertEqual(process.returncode, 1)
        self.assertIn("/dev/full: cannot be written: No space left on device", process.stderr)
        # also where all rows are in a buffer until the end
        process = self.align("sweep", self.study(without=["vary", "samples"]), "--csv", "/dev/full")
        self.assertEqual(process.returncode, 1)
        self.assertIn("/dev/full: cannot be written: No space left on device", process.stderr)
        with open("/dev/full", "w") as full:
            process = self.align("sweep", self.study(), stdout=full)
        self.assertEqual(process.returncode, 1)
        self.assertIn("stdout", process.stderr)


if __name__ == "__main__":
    unittest.main()
