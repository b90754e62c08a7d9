#!/usr/bin/python3
"""Measures running nodes for a long time, and writes what was seen as a page with pictures.

Calls measure_latency and makes OUT/latency.json, report.md, latency.png and load.png of it; with the
true trajectory, as simulate writes it, OUT/online.tum and error.png, too. With --simulate it starts
all that it measures, a simulated robot included, with a master of its own. Ctrl-C ends the
measurement and makes the page. Exit codes: those of measure_latency, 2 if a package is missing.
"""
import argparse
import json
import os
import signal
import socket
import subprocess
import sys
import time

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError as missing:
    print("soak.py: %s; install it with: sudo apt install python3-matplotlib" % missing,
          file=sys.stderr)
    sys.exit(2)


ROUNDS = 1000  # more than a day's
CONNECT = 30.0  # the nodes have so long to begin [s]


def start_simulation(arguments):
    """The three nodes and a robot that drives its path again and again, at a port that is free."""
    with socket.socket() as free:
        free.bind(("", 0))
        port = free.getsockname()[1]
    out = os.path.abspath(arguments.out)
    os.environ.update(ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOSTNAME="localhost",
                      ROS_HOME=os.path.join(out, "ros"))
    with open(os.path.join(out, "roslaunch.log"), "w") as log:
        launch = subprocess.Popen(
            ["roslaunch", "-p", str(port), "scan_image_slam", "simulation.launch", "rviz:=false",
             "world:=" + arguments.simulate, "rounds:=%d" % ROUNDS, "map_folder:=" + out],
            stdout=log, stderr=log, start_new_session=True)
    end = time.monotonic() + CONNECT
    while time.monotonic() < end and launch.poll() is None and subprocess.run(
            ["rosparam", "get", "/run_id"], stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL).returncode != 0:
        time.sleep(0.2)
    return launch


def program(arguments, name):
    if arguments.programs:
        return [os.path.join(arguments.programs, name)]
    return ["rosrun", "scan_image_slam", name]


def wait_for(process):
    while True:
        try:
            return process.wait()
        except KeyboardInterrupt:
            pass  # it got the signal, too, and writes what it has


def measure(arguments, path):
    command = program(arguments, "measure_latency")
    command += ["--json", path, "--period", str(arguments.period),
                "--scan-topic", arguments.scan_topic, "--pose-topic", arguments.pose_topic]
    if arguments.duration:
        command += ["--duration", str(arguments.duration)]
    if arguments.simulate:
        command += ["--wait", str(CONNECT)]
    recorder = None
    if arguments.truth or arguments.simulate:
        recorder = subprocess.Popen(
            program(arguments, "trajectory_recorder") +
            ["_folder:=" + arguments.out, "pose:=" + arguments.pose_topic],
            stdout=subprocess.DEVNULL)
    try:
        return wait_for(subprocess.Popen(command))
    finally:
        if recorder:
            recorder.send_signal(signal.SIGINT)
            wait_for(recorder)


def judge(arguments):
    """Lines about the errors of the poses, from where the first of them lies on the truth."""
    online = os.path.join(arguments.out, "online.tum")
    try:
        subprocess.run(program(arguments, "plot_trajectory.py") +
                       ["--reference", arguments.truth, "--estimate", online,
                        "--out", os.path.join(arguments.out, "error.png")], check=True)
        printed = subprocess.run(
            program(arguments, "evaluate_trajectory") + [arguments.truth, online],
            check=True, text=True, stdout=subprocess.PIPE).stdout
    except subprocess.CalledProcessError:  # which has said why; the rest is of use without it
        return ["The poses could not be compared with %s." % arguments.truth, ""]
    values = dict(word.split("=") for word in printed.split())
    return ["Error of the pose: %s m (ATE), at worst %s m, over %s m." %
            (values["ate_rmse_m"], values["ate_max_m"], values["path_m"]), "",
            "![error](error.png)", ""]


def ends(periods):
    """When the periods ended [min]."""
    seconds = 0.0
    for period in periods:
        seconds += period["seconds"]
        yield seconds / 60


def draw_latency(report, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4))
    rows = report["histogram"]
    labels = ["more" if r["up_to_ms"] is None else "%g" % r["up_to_ms"] for r in rows]
    left.bar(labels, [r["scans"] for r in rows], log=True)
    left.tick_params(axis="x", rotation=60)
    left.set(xlabel="from scan to pose, up to [ms]", ylabel="scans")
    minutes = list(ends(report["periods"]))
    for name in ("p50", "p99", "max"):
        right.plot(minutes, [p["latency_ms"].get(name) for p in report["periods"]], label=name)
    right.set(xlabel="time [min]", ylabel="from scan to pose [ms]", ylim=(0, None))
    right.legend()
    figure.tight_layout()
    figure.savefig(path)


def draw_load(report, path):
    figure, axes = plt.subplots(1, 2, figsize=(11, 4))
    minutes = list(ends(report["periods"]))
    for axis, key, label in zip(axes, ("cpu_percent", "memory_mb"),
                                ("of one core [%]", "memory [MB]")):
        for node in sorted(report["nodes"]):
            values = [p["nodes"].get(node, {}).get(key, float("nan")) for p in report["periods"]]
            axis.plot(minutes, values, label=node)
        axis.set(xlabel="time [min]", ylabel=label, ylim=(0, None))
    axes[0].legend()
    figure.tight_layout()
    figure.savefig(path)


def growth(report, node):
    """Of a node's memory over the second half, by its first and last quarter [MB per hour]."""
    half = report["periods"][len(report["periods"]) // 2:]
    values = [p["nodes"][node]["memory_mb"] for p in half if node in p["nodes"]]
    quarter = len(values) // 2
    if quarter == 0:
        return None
    first, last = sum(values[:quarter]) / quarter, sum(values[-quarter:]) / quarter
    between = sum(p["seconds"] for p in half) * (len(values) - quarter) / len(values)
    return (last - first) / between * 3600


def first_and_last(report, node, key):
    values = [p["nodes"][node][key] for p in report["periods"] if node in p["nodes"]]
    return "%d, %d" % (values[0], values[-1]) if values else ""


def page(report, judgement):
    latency = ["-" if report["latency_ms"][key] is None else "%.1f" % report["latency_ms"][key]
               for key in ("p50", "p90", "p99", "max")]
    lines = ["# Long run", "",
             "%.2f hours, %d scans, %d of them without a pose; %d poses that are not finite." %
             (report["seconds"] / 3600, report["scans"], report["dropped"],
              report["poses_not_finite"]), "",
             "From scan to pose [ms]: half within %s, 90 %% within %s, 99 %% within %s, "
             "longest %s." % tuple(latency), "",
             "![latency](latency.png)", "",
             "| node | one core [%] | per scan [ms] | memory [MB] | at most [MB] "
             "| growth in the second half [MB/h] | threads at first, in the end | open files |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for node, load in sorted(report["nodes"].items()):
        grown = growth(report, node)
        lines.append("| %s | %.1f | %.2f | %.0f | %.0f | %s | %s | %s |" % (
            node, load["cpu_percent"], load["cpu_ms_per_scan"], load["memory_mb"],
            load["peak_memory_mb"], "" if grown is None else "%.1f" % grown,
            first_and_last(report, node, "threads"), first_and_last(report, node, "open_files")))
    return "\n".join(lines + ["", "![load](load.png)", ""] + judgement)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", required=True, help="folder for the page")
    parser.add_argument("--duration", type=float, help="[s]; without it, until Ctrl-C")
    parser.add_argument("--period", type=float, default=10.0, help="between two looks [s]")
    parser.add_argument("--scan-topic", default="scan")
    parser.add_argument("--pose-topic", default="pose")
    parser.add_argument("--truth", help="true trajectory of the run, TUM format: to judge the poses")
    parser.add_argument("--simulate", metavar="WORLD",
                        help="start nodes and a simulated robot in this world")
    parser.add_argument("--programs", help="folder of measure_latency, if rosrun does not find it")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    path = os.path.join(arguments.out, "latency.json")
    launch = start_simulation(arguments) if arguments.simulate else None
    try:
        code = measure(arguments, path)
    finally:
        if launch:
            launch.send_signal(signal.SIGINT)
            wait_for(launch)
    if arguments.simulate:  # the robot itself has told it
        arguments.truth = os.path.join(arguments.out, "truth.tum")
    if code != 0:
        return code
    with open(path) as file:
        report = json.load(file)
    draw_latency(report, os.path.join(arguments.out, "latency.png"))
    draw_load(report, os.path.join(arguments.out, "load.png"))
    judgement = judge(arguments) if arguments.truth else []
    with open(os.path.join(arguments.out, "report.md"), "w") as file:
        file.write(page(report, judgement))
    print(os.path.join(arguments.out, "report.md"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
