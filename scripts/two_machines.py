#!/usr/bin/python3
"""Tries the robot and its base station as two machines, with a bad link between them.

Makes two network namespaces, robot and base, with a link between them that delays packets, loses some
of them, or is cut for a while. On the robot's side run the master, a simulated robot and
robot_side.launch, at the base base_side.launch; then the poses are judged as the robot hears them.
One row for each link: the traffic each way, latencies, and errors of the poses. Must run as root, in
an environment in which roslaunch finds the package; needs iproute2. Exit codes: 1 if something could
not be measured, 2 if it can't be tried here.
"""
import argparse
import fcntl
import heapq
import json
import os
import random
import selectors
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

ADDRESSES = {"robot": "10.91.0.1", "base": "10.91.0.2"}
PORT = 11311
START_UP = 8.0  # nodes find each other so long before anything is measured [s]
TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454CA, 0x0001, 0x1000


class Link(threading.Thread):
    """Carries packets between the namespaces' interfaces. Which are lost is drawn with a fixed seed."""

    def __init__(self, names, delay, loss):
        super().__init__(daemon=True)
        self._delay, self._loss = delay, loss
        self._random = random.Random(1)
        self._ends = [self._open(name) for name in names]
        self.cut = False
        self.bytes = [0, 0]  # sent by each end
        self._ended = False

    @staticmethod
    def _open(name):
        end = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
        fcntl.ioctl(end, TUNSETIFF, struct.pack("16sH", name.encode(), IFF_TUN | IFF_NO_PI))
        return end

    def run(self):
        selector = selectors.DefaultSelector()
        for index, end in enumerate(self._ends):
            selector.register(end, selectors.EVENT_READ, index)
        waiting, count = [], 0
        while not self._ended:
            pause = waiting[0][0] - time.monotonic() if waiting else 0.1
            for key, _ in selector.select(max(0.0, min(pause, 0.1))):
                packet = os.read(key.fd, 65536)
                self.bytes[key.data] += len(packet)
                if self.cut or self._random.random() < self._loss:
                    continue
                count += 1  # packets that come together stay in order
                heapq.heappush(waiting, (time.monotonic() + self._delay, count, 1 - key.data, packet))
            while waiting and waiting[0][0] <= time.monotonic():
                _, _, end, packet = heapq.heappop(waiting)
                try:
                    os.write(self._ends[end], packet)
                except OSError:  # nobody is there yet, or any more
                    pass

    def close(self):
        self._ended = True
        self.join()
        for end in self._ends:
            os.close(end)


class Machines:
    """Two namespaces, and the processes in them."""

    def __init__(self, delay, loss, log):
        self._log = log
        self._processes = []
        tag = "sis%d" % (os.getpid() % 100000)
        self._spaces = {side: "%s-%s" % (tag, side) for side in ADDRESSES}
        interfaces = {side: tag + side[0] for side in ADDRESSES}
        self.link = Link(interfaces.values(), delay, loss)
        try:
            for side, address in ADDRESSES.items():
                ip("netns", "add", self._spaces[side])
                ip("link", "set", interfaces[side], "netns", self._spaces[side])
                inside = ("-n", self._spaces[side])
                ip(*inside, "link", "set", "lo", "up")
                ip(*inside, "addr", "add", address + "/24", "dev", interfaces[side])
                ip(*inside, "link", "set", interfaces[side], "up")
        except Exception:
            self.close()
            raise
        self.link.start()

    def command(self, side, *words):
        return ["ip", "netns", "exec", self._spaces[side], "env", "ROS_IP=" + ADDRESSES[side],
                "ROS_MASTER_URI=http://%s:%d" % (ADDRESSES["robot"], PORT), *words]

    def start(self, side, *words):
        process = subprocess.Popen(self.command(side, *words), stdout=self._log, stderr=self._log,
                                   start_new_session=True)
        self._processes.append(process)
        return process

    def close(self):
        for process in reversed(self._processes):
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGINT)
        for process in self._processes:
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
        if self.link.is_alive():
            self.link.close()
        for space in self._spaces.values():
            subprocess.run(["ip", "netns", "del", space], stderr=subprocess.DEVNULL)


def ip(*words):
    subprocess.run(["ip", *words], check=True)


def try_link(arguments, name, delay, loss, cut):
    """One row of the table."""
    folder = os.path.join(arguments.out, name)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "log"), "w") as log:
        machines = Machines(delay, loss, log)
        try:
            machines.start("robot", "roscore", "-p", str(PORT))
            time.sleep(2.0)
            machines.start("robot", "roslaunch", "--wait", "scan_image_slam", "robot_side.launch",
                           "publish_mounts:=false")
            machines.start("base", "roslaunch", "--wait", "scan_image_slam", "base_side.launch",
                           "rviz:=false")
            recorder = machines.start("robot", "rosrun", "scan_image_slam", "trajectory_recorder",
                                      "_folder:=" + folder)
            time.sleep(START_UP)
            machines.start("robot", "rosrun", "scan_image_slam", "robot_simulator",
                           "_world:=" + arguments.world)
            report = os.path.join(folder, "latency.json")
            meter = machines.start("robot", "rosrun", "scan_image_slam", "measure_latency",
                                   "--wait", "60", "--duration", str(arguments.duration),
                                   "--json", report)
            wait_for_poses(machines)
            begin, sent = time.monotonic(), list(machines.link.bytes)
            if cut > 0.0:
                time.sleep(arguments.duration / 4)
                machines.link.cut = True
                time.sleep(cut)
                machines.link.cut = False
            code = meter.wait(arguments.duration + 120)
            seconds = time.monotonic() - begin
            rates = [(now - before) / seconds / 1e6
                     for now, before in zip(machines.link.bytes, sent)]
            os.killpg(recorder.pid, signal.SIGINT)
            recorder.wait(60)
        finally:
            machines.close()
    if code != 0:
        raise RuntimeError("measure_latency ended with %d; see %s" % (code, log.name))
    with open(report) as file:
        measured = json.load(file)
    words = subprocess.run(
        ["rosrun", "scan_image_slam", "evaluate_trajectory", os.path.join(folder, "truth.tum"),
         os.path.join(folder, "online.tum")], check=True, text=True, stdout=subprocess.PIPE).stdout
    errors = dict(word.split("=") for word in words.split())
    latency = measured["latency_ms"]
    return "| %s | %.2f MB/s | %.2f MB/s | %.1f | %.1f | %d of %d | %.1f mm, %.1f mm |" % (
        describe(delay, loss, cut), *rates, latency["p50"], latency["p99"], measured["dropped"],
        measured["scans"], 1e3 * float(errors["ate_rmse_m"]), 1e3 * float(errors["ate_max_m"]))


def wait_for_poses(machines):
    subprocess.run(machines.command("robot", "timeout", "60", "rostopic", "echo", "-n", "1", "/pose"),
                   check=True, stdout=subprocess.DEVNULL)


def describe(delay, loss, cut):
    if delay == 0.0 and loss == 0.0 and cut == 0.0:
        return "no delay"
    words = "%.0f ms for both ways, %.0f %% of packets lost each way" % (2e3 * delay, 100 * loss)
    return words + (", cut for %.0f s" % cut if cut > 0.0 else "")


def what_is_missing():
    if os.geteuid() != 0:
        return "network namespaces are for root"
    if not os.path.exists("/dev/net/tun"):
        return "there is no /dev/net/tun"
    for program in ("ip", "roslaunch"):
        if subprocess.run(["which", program], stdout=subprocess.DEVNULL).returncode != 0:
            return "there is no program " + program
    for command in (["unshare", "--net", "true"], ["rospack", "find", "scan_image_slam"]):
        tried = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if tried.returncode != 0:
            return tried.stderr.strip()
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", help="folder for what was measured; default: a temporary one")
    parser.add_argument("--world", default="laboratory")
    parser.add_argument("--duration", type=float, default=60.0, help="of each row [s]")
    parser.add_argument("--cut", type=float, default=20.0, help="of the link, in the last row [s]")
    parser.add_argument("--only", choices=("good", "bad", "cut"), help="one row")
    arguments = parser.parse_args()
    missing = what_is_missing()
    if missing:
        print("two_machines.py: " + missing, file=sys.stderr)
        return 2
    arguments.out = os.path.abspath(arguments.out or tempfile.mkdtemp())
    links = {"good": (0.0, 0.0, 0.0), "bad": (0.05, 0.05, 0.0), "cut": (0.05, 0.05, arguments.cut)}
    print("| link | robot to base | base to robot | scan to pose [ms]: half | 99 % "
          "| scans without a pose | error of the pose (ATE), at worst |")
    print("| --- | --- | --- | --- | --- | --- | --- |", flush=True)
    for name, link in links.items():
        if arguments.only in (None, name):
            print(try_link(arguments, name, *link), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
