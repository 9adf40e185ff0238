"""The benches refuse what they cannot use, in words, and leave the page of docs/ as it was."""

import os
import resource
import shutil
import subprocess
import sys
import unittest

from align_test_case import SOURCE_ROOT, AlignTestCase

HEAD = "peer,problem,setting,x,y,phi,vx,vy,omega,rhs,steps,events,cpu_min_s,cpu_median_s\n"
PROBLEMS = ("r1", "r1_stiff", "lasting", "lasting_overdamped")
PEERS = ("reference", "own_event", "odeint_dopri5")


def line(peer, problem):
    return "%s,%s,1e-6,0.1,0.9,0.0,0.0,0.0,0.0,10,5,2,0.001,0.001\n" % (peer, problem)


def whole_csv():
    """What bench/peers/run prints, as far as docs/accuracy.md needs it."""
    lines = [line(peer, problem) for peer in PEERS for problem in PROBLEMS]
    return HEAD + "".join(lines + [line(peer, problem + "_dry") for peer in PEERS[:2] for problem in PROBLEMS])


class BenchTest(AlignTestCase):
    """A copy of the benches with a page of their own."""

    def setUp(self):
        super().setUp()
        for folder in ("bench/peers", "bench/support", "scripts"):
            shutil.copytree(os.path.join(SOURCE_ROOT, folder), self.path(folder))
        os.makedirs(self.path("docs/images"))
        self.page = self.write("docs/accuracy.md", "head\n<!-- results -->\nold\n<!-- results -->\ntail\n")

    def run_bench(self, script, *arguments, **options):
        return subprocess.run([sys.executable, self.path(script)] + list(arguments), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, timeout=120, **options)

    def assert_ends_with(self, process, *words):
        self.assertEqual((process.returncode, process.stdout), (1, ""), process.stderr)
        for word in words:
            self.assertIn(word, process.stderr)
        self.assertNotIn("Traceback", process.stderr)

    def assert_page_is_as_before(self):
        with open(self.page) as file:
            self.assertIn("\nold\n", file.read())
        self.assertEqual(sorted(os.listdir(self.path("docs"))), ["accuracy.md", "images"])
        self.assertEqual(os.listdir(self.path("docs/images")), [])

    def test_lines_that_are_none_are_named(self):
        whole = line("own_event", "r1")
        for text, number in (("", 1), (whole, 1), (HEAD + whole + HEAD, 3), (HEAD + whole[:-1], 2), (b"\xff\x00\n", 1),
                             (HEAD + whole + "own_event,r1,1e-6\n", 3)):
            with self.subTest(text):
                csv = self.write("peers.csv", text)
                self.assert_ends_with(self.run_bench("bench/peers/table.py", csv), "%s: line %d: " % (csv, number))
        self.assert_ends_with(self.run_bench("bench/peers/table.py", self.write("peers.csv", HEAD)), "holds no run")
        self.assert_ends_with(self.run_bench("bench/peers/table.py", self.path("none.csv")), "none.csv: No such file")
        self.assert_ends_with(self.run_bench("bench/peers/table.py"), "Usage: ")

    def test_a_page_is_written_of_all_problems_only(self):
        for left_out, words in ((line("own_event", "r1_dry"), "no run of an own solver on r1_dry"),
                                (line("odeint_dopri5", "lasting"), "no run of a peer on lasting"),
                                (line("reference", "r1_stiff_dry"), "no answer to r1_stiff_dry")):
            with self.subTest(words):
                csv = self.write("peers.csv", whole_csv().replace(left_out, ""))
                self.assert_ends_with(self.run_bench("bench/peers/accuracy_page.py", csv), words)
                self.assert_page_is_as_before()

    def test_a_page_is_drawn_before_it_is_written(self):
        csv = self.write("peers.csv", whole_csv() + line("own_unknown", "r1"))
        self.assert_ends_with(self.run_bench("bench/peers/accuracy_page.py", csv), "own_unknown: has no colour")
        self.assert_page_is_as_before()

    def test_a_whole_page_comes_with_its_figure(self):
        process = self.run_bench("bench/peers/accuracy_page.py", self.write("peers.csv", whole_csv()))
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        with open(self.page) as file:
            text = file.read()
        self.assertTrue(text.startswith("head\n<!-- results -->\nMade on "), text)
        self.assertTrue(text.endswith("|\n\n<!-- results -->\ntail\n"), text)
        self.assertIn("### lasting contact, dry", text)
        self.assertEqual(os.listdir(self.path("docs/images")), ["accuracy.svg"])

    def test_a_page_that_cannot_be_written_stays(self):
        code = "import bench_tools; bench_tools.replace_table('accuracy.md', 'results', 'new' * 1000)"
        process = subprocess.run([sys.executable, "-c", code], cwd=self.path("bench/support"), stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, universal_newlines=True, timeout=120,
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)))
        self.assert_ends_with(process, "accuracy.md: cannot be written: File too large")
        self.assert_page_is_as_before()

    def test_turns_are_refused_before_they_are_taken(self):
        csv = self.write("peers.csv", whole_csv())
        for turns in ("abc", "0", "1"):
            self.assert_ends_with(self.run_bench("bench/peers/in_turns.py", "build", csv, turns), "TURNS " + turns)
        self.assert_ends_with(self.run_bench("bench/peers/in_turns.py", "build", csv), "is not built", "--target cost")


if __name__ == "__main__":
    unittest.main()
