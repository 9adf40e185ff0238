"""What the benches of the node share: a master of their own, the running node, and what /proc says of it."""

import os
import signal
import socket
import subprocess
import sys
import time

import yaml
from bench_tools import ROOT


def long_scene(seconds=3600.0):
    """Text of a scene in which the part bounces all the time instead of aligning: the gripper holds it sideways."""
    with open(os.path.join(ROOT, "config", "scenes", "gripper_si.yaml")) as file:
        scene = yaml.safe_load(file)
    scene["gripper"]["stiffness"]["x"] = 4000.0
    scene["trial"]["time_limit"] = seconds
    return yaml.safe_dump(scene)


def use_own_master(folder):
    """Names of a master that is to be started, and of a folder for logs, for all processes from now on."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        os.environ["ROS_MASTER_URI"] = "http://127.0.0.1:%d" % one.getsockname()[1]
    os.environ["ROS_IP"] = "127.0.0.1"
    os.environ["ROS_HOME"] = os.environ["ROS_LOG_DIR"] = folder


def launch_log():
    """What roslaunch says."""
    return os.path.join(os.environ["ROS_LOG_DIR"], "roslaunch.txt")


def launch_node(*arguments):
    """roslaunch of the node, and of the master with it, as a process."""
    port = os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1]
    with open(launch_log(), "w") as log:
        return subprocess.Popen(["roslaunch", "-p", port, "vibratory_alignment", "trial.launch", "rviz:=false"] +
                                list(arguments), stdout=log, stderr=subprocess.STDOUT)


def stop(process):
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
        process.wait()


def node_pid():
    """Process of the node, as its master knows it."""
    import rosgraph
    import xmlrpc.client
    uri = rosgraph.Master("/bench").lookupNode("/aligner")
    return xmlrpc.client.ServerProxy(uri).getPid("/bench")[2]


def wait_for_node(launch):
    """Process of the node; where none comes up the bench ends with the last lines of roslaunch."""
    deadline = time.monotonic() + 30.0
    while launch.poll() is None and time.monotonic() < deadline:
        try:
            return node_pid()
        except Exception:  # the master or the node is not there yet
            time.sleep(0.1)
    with open(launch_log()) as log:
        last = "".join(log.readlines()[-5:]).strip()
    sys.exit("the node has not come up; roslaunch says:\n" + last)


def cpu_seconds(stat):
    """User and system time in a file `stat` of a process or thread."""
    with open(stat) as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def resident_megabytes(pid):
    """Memory of the process that is in RAM; None when it has ended."""
    try:
        with open("/proc/%d/statm" % pid) as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6
    except (FileNotFoundError, ProcessLookupError):
        return None
