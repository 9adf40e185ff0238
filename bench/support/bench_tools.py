"""What the benches that write tables share: counting instructions, naming the machine, replacing a page's table."""

import argparse
import contextlib
import datetime
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
# Of the programs that are started, those of the system.
os.environ["PATH"] = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"

# Only what steps the trial is counted, not the reading of the scene.
COUNTED = "vibratory_alignment::Simulation::advance()"


class EndedBySignal(KeyboardInterrupt):
    """By another signal than that of Ctrl-C; its argument is the number."""


def run(main):
    """Runs a bench. Ctrl-C, SIGTERM and SIGHUP end it without a traceback, and what it has started with it."""
    def end(number, _):
        raise EndedBySignal(number)
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, end)
    try:
        main()
    except EndedBySignal as ended:
        sys.exit(128 + ended.args[0])
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)


def positive(kind):
    """A type of argparse: numbers of the kind that are above 0."""
    def parse(text):
        try:
            value = kind(text)
        except ValueError:
            value = 0
        if not 0 < value < float("inf"):
            raise argparse.ArgumentTypeError("%s: must be a number above 0" % text)
        return value
    parse.__name__ = kind.__name__
    return parse


def output_of(command):
    """What a program prints; ends the bench where it fails."""
    process = subprocess.run(command, stdout=subprocess.PIPE, universal_newlines=True)
    if process.returncode != 0:
        sys.exit("%s: exit status %d" % (" ".join(command), process.returncode))
    return process.stdout


def count(command, folder, counted=COUNTED):
    """What the program prints, under callgrind; its files go to the folder. counted None: all of the program."""
    collect = ["--toggle-collect=" + counted] if counted else []
    # without vgdb, whose FIFOs stay in /tmp after an interrupt
    return output_of(["valgrind", "--tool=callgrind", "--vgdb=no", "--log-file=" + os.path.join(folder, "log"),
                      "--callgrind-out-file=" + os.path.join(folder, "out")] + collect + command)


def instructions_of(command):
    """(what the program prints, instructions in Simulation::advance), under callgrind."""
    with tempfile.TemporaryDirectory(prefix="bench_") as folder:
        text = count(command, folder)
        with open(os.path.join(folder, "log")) as file:
            return text, int(re.search(r"Collected : (\d+)", file.read()).group(1))


def instructions_by_function(command, functions, counted=COUNTED):
    """(what the program prints, {function: instructions in it and in all that it calls}) in Simulation::advance."""
    with tempfile.TemporaryDirectory(prefix="bench_") as folder:
        text = count(command, folder, counted)
        listing = output_of(["callgrind_annotate", "--inclusive=yes", "--threshold=100", os.path.join(folder, "out")])
    found = {}
    for line in listing.splitlines():
        entry = re.match(r" *([\d,]+) \([ \d.]+%\)\s+\S+?:(?:vibratory_alignment::)?([\w:]+)(?:\[abi:\w+\])?\(", line)
        if entry and entry.group(2) in functions:
            found[entry.group(2)] = max(found.get(entry.group(2), 0), int(entry.group(1).replace(",", "")))
    return text, {name: found.get(name, 0) for name in functions}


def require_valgrind():
    if not shutil.which("valgrind"):
        sys.exit("valgrind is missing: apt-get install valgrind")


def require_program(path, build, target):
    """The path; ends the bench where there is no program."""
    if not os.access(path, os.X_OK):
        sys.exit("%s is not built: cmake --build %s --target %s" % (path, build, target))
    return path


def program_of(build, name):
    """A program of the package: that of the build directory's own devel/, else that of the checkout's."""
    own, common = (os.path.join(root, "devel", "lib", "vibratory_alignment", name) for root in (build, ROOT))
    return own if os.path.exists(own) else require_program(common, build, name)


def stamp(command):
    """The line above a table: which command made it, when and on what."""
    with open("/proc/cpuinfo") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return "Made by `%s` on %s, %s, %d cores." % (
        command, datetime.datetime.utcnow().strftime("%Y-%m-%d"), names[0] if names else "unknown processor",
        os.cpu_count())


def markdown(head, rows):
    lines = ["| %s |" % " | ".join(head), "|" + "---|" * len(head)]
    return "\n".join(lines + ["| %s |" % " | ".join(row) for row in rows]) + "\n"


def write_files(contents):
    """Puts the bytes into the files of these paths; where one cannot be written all stay as they were."""
    try:
        for path, content in contents.items():
            with open(path + ".new", "wb") as file:
                file.write(content)
        for path in contents:
            os.replace(path + ".new", path)
    except OSError as error:
        sys.exit("%s: cannot be written: %s" % (path, error.strerror))
    finally:
        for path in contents:
            with contextlib.suppress(OSError):
                os.remove(path + ".new")


def with_table(path, name, text):
    """The page with `text` between its two lines <!-- NAME -->, as bytes."""
    mark = "<!-- %s -->" % name
    with open(path, encoding="utf-8") as file:
        parts = file.read().split(mark)
    if len(parts) != 3:
        sys.exit("%s: needs two lines %s" % (path, mark))
    return (parts[0] + mark + "\n" + text + mark + parts[2]).encode()


def replace_table(page, name, text):
    """Puts `text` between the two lines <!-- NAME --> of a page of docs/."""
    path = os.path.join(ROOT, "docs", page)
    write_files({path: with_table(path, name, text)})
