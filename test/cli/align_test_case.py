"""What the tests of the command `align` share: they run the real command and look at what it prints and leaves.

The environment variable ALIGN names the command, e.g. ALIGN=devel/lib/vibratory_alignment/align.
"""

import copy
import json
import os
import pty
import select
import shutil
import subprocess
import tempfile
import time
import unittest

import yaml

SOURCE_ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# A short trial with few contacts, apart from the shipped scenes so that tuning these breaks no test here.
SMALL_SCENE = {
    "name": "small",
    "units": "dimensionless",
    "part": {"half_width": 0.7, "base_distance": 0.9, "inertia": 0.3},
    "slot": {"clearance": 0.09},
    "gripper": {
        "stiffness": {"x": 0.05, "phi": 60.0},
        "damping": {"x": 0.05, "y": 0.05, "phi": 0.05},
        "pressing_force": 0.2,
    },
    "base": {"stiffness": {"y": 2500.0}, "damping": {"y": 20.0}},
    "contacts": ["edges"],
    "friction": {"coefficient": 0.2},
    "excitation": {"amplitude": 1.0, "frequency": 20.0},
    "initial": {"x": 0.2},
    "trial": {"time_limit": 3.0},
}

# One impact in SI units: a part that cannot tilt, on a base without damping, falls 1 mm on its spring at rest at the
# height of touch, and slides to the right at 2 m/s; its length lets it do so on one edge.
BALL_SI = {
    "name": "ball",
    "units": "si",
    "part": {"mass": 0.1, "half_width": 2.0, "base_distance": 1.8e-3},
    "slot": {"clearance": 2.0e-4},
    "gripper": {"stiffness": {"x": 0.0, "y": 4000.0}, "anchor": {"y": 1.8e-3}},
    "base": {"stiffness": {"y": 4.0e7}},
    "contacts": ["edges"],
    "friction": {"coefficient": 0.1},
    "excitation": {"force": 0.0, "frequency": 10.0},
    "initial": {"x": 0.4, "y": 2.8e-3, "vx": 2.0},
    "trial": {"time_limit": 0.01},
    "solver": {"tolerance": 1.0e-12},
}


class AlignTestCase(unittest.TestCase):
    """A test with a directory of its own in which `align` runs."""

    def setUp(self):
        self.align_path = os.path.abspath(os.environ["ALIGN"])
        self.directory = tempfile.mkdtemp(prefix="align_test_")
        self.addCleanup(shutil.rmtree, self.directory)

    def path(self, name):
        return os.path.join(self.directory, name)

    def write(self, name, content):
        """Writes text or bytes; returns the path."""
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return self.path(name)

    def scene(self, name="small.yaml", without=(), **changes):
        """Writes SMALL_SCENE with other sections, or without some; returns the path."""
        tree = copy.deepcopy(SMALL_SCENE)
        tree.update(changes)
        for key in without:
            del tree[key]
        return self.write(name, yaml.safe_dump(tree))

    def align(self, *arguments, **options):
        """Runs align; returns the finished process, whose stdout and stderr are text."""
        environment = {**os.environ, "ROS_PACKAGE_PATH": SOURCE_ROOT, **options.pop("environment", {})}
        return subprocess.run(
            [self.align_path] + [str(argument) for argument in arguments],
            cwd=self.directory,
            env=environment,
            stdout=options.pop("stdout", subprocess.PIPE),
            stderr=subprocess.PIPE,
            universal_newlines=True,
            timeout=120,
            **options,
        )

    def trial(self, *arguments, **options):
        """Runs `align trial ... --json`, which must succeed; returns the object it prints."""
        process = self.align("trial", *(list(arguments) + ["--json"]), **options)
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual(process.stderr, "")
        return json.loads(process.stdout)

    def seen(self, *arguments, until=None):
        """What a terminal gets of a run, which is ended once it has got `until`, or after three seconds."""
        terminal, stdout = pty.openpty()
        process = subprocess.Popen([self.align_path] + list(arguments), cwd=self.directory, stdout=stdout,
                                   stderr=subprocess.DEVNULL, env=dict(os.environ, TERM="xterm"))
        os.close(stdout)
        deadline = time.monotonic() + (60 if until else 3)
        text = b""
        while time.monotonic() < deadline and not (until and until in text):
            if select.select([terminal], [], [], 0.1)[0]:
                text += os.read(terminal, 65536)
        os.close(terminal)
        process.kill()
        process.wait(timeout=30)
        return text

    def interrupted_while_drawing(self, number, *arguments):
        """Sends the signal to a run whose drawing takes for ever, and to nothing else; returns the finished process."""
        os.makedirs(self.path("modules"), exist_ok=True)
        begun = self.path("modules/begun")
        self.write("modules/matplotlib.py", "import time\nopen(%r, 'w').close()\ntime.sleep(600)\n" % begun)
        process = subprocess.Popen(
            [self.align_path] + list(arguments), cwd=self.directory, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            env=dict(os.environ, ROS_PACKAGE_PATH=SOURCE_ROOT, PYTHONPATH=self.path("modules")), universal_newlines=True)
        self.addCleanup(process.kill)
        while process.poll() is None and not os.path.exists(begun):
            time.sleep(0.01)
        process.send_signal(number)
        output, messages = process.communicate(timeout=30)
        shutil.rmtree(self.path("modules"))
        return subprocess.CompletedProcess(process.args, process.returncode, output, messages)

    def assert_refused(self, arguments, *words):
        """align ends with 2, prints nothing on stdout and every word on stderr, in words fit for people."""
        process = self.align(*arguments)
        self.assertEqual(process.returncode, 2, process.stderr)
        self.assertEqual(process.stdout, "")
        for word in words:
            self.assertIn(str(word), process.stderr)
        for jargon in ("terminate called", "std::", "exception", "Assertion"):
            self.assertNotIn(jargon, process.stderr)
        return process.stderr
