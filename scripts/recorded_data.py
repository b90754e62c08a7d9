#!/usr/bin/env python3
"""Runs slam_offline on recordings and prints what came out, as the table of README.md.

  scripts/recorded_data.py DATA TOOLS [--out FOLDER] [--only NAME ...]

Takes every NAME.bag in DATA; NAME.gt.tum beside it is its true trajectory, NAME.relations are its
true motions. TOOLS is the folder of the programs: <devel space>/lib/scan_image_slam. With --out the
maps and trajectories are kept, in FOLDER/NAME.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile

WITHOUT_LOOPS = ["--set", "mapper/loop/enabled=false"]
# What is known of recordings beside what they hold: content, and options that they need.
KNOWN = {
    "intel": ("Intel Research Lab, 508 m, 180 beams at 5 Hz, bad encoders", []),
    "mines_test_lab": ("laboratory, URG-04LX at 10 Hz, wheels slip by 90°", []),
    "mines_exp1": ("corridor and rooms, URG-04LX at 10 Hz", []),
    "robot_hokuyo_col2": ("real robot indoors, 726 beams at 10 Hz", []),
    "neato_square": ("Neato robot, 361 beams at 5 Hz, laser looks backwards", []),
    "hokuyo_handheld": ("Hokuyo carried by hand, 10 Hz, no encoders", []),
    "independent_lab": ("laboratory of another simulator, laser, camera, encoders at 40, 30, 50 Hz",
                        []),
    "neato_camera_static": ("Neato robot standing still, camera at 30 Hz",
                            ["--set", "scan_image_fusion/camera/from_tf=false",
                             "--set", "scan_image_fusion/camera/x=-0.1",
                             "--set", "scan_image_fusion/camera/z=0.19",
                             "--set", "scan_image_fusion/camera/pitch_deg=5.5",
                             "--set", "scan_image_fusion/min_edge_length=0.08",
                             "--fusion-images", "30"]),
}
HEAD = ["recording", "what", "scans", "images", "CPU per scan [ms]", "memory [MB]",
        "loop closures", "error"]


class ToolError(Exception):
    """A program could not do its work."""


def run(tools, name, *arguments):
    result = subprocess.run([os.path.join(tools, name), *arguments], stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if result.returncode != 0:
        raise ToolError(f"{name} {' '.join(arguments)}: {result.stderr.strip()}")
    return dict(re.findall(r"(\S+)=(\S+)", result.stdout))


def slam(tools, bag, out, options):
    run(tools, "slam_offline", "--bag", bag, "--out", out, *options)
    with open(os.path.join(out, "report.json")) as file:
        return json.load(file)


def relation_errors(tools, reference, bag, out, options):
    slam(tools, bag, out + ".no_loops", options + WITHOUT_LOOPS)
    parts = []
    for what, folder, name in (("", out, "trajectory"), ("as known live ", out, "online"),
                               ("without loop closing ", out + ".no_loops", "online")):
        errors = run(tools, "evaluate_relations", reference, f"{folder}/{name}.tum")
        parts.append(f"{what}{float(errors['trans_mean_m']):.3f} m "
                     f"(median {float(errors['trans_median_m']):.3f} m)")
    return "relations: " + ", ".join(parts)


def trajectory_errors(tools, reference, bag, out, options, images):
    paths = [("", f"{out}/online.tum")]
    if images:
        slam(tools, bag, out + ".no_images", options + ["--no-images"])
        paths.append(("without images ", f"{out}.no_images/online.tum"))
    paths.append(("encoders ", f"{out}/encoder.tum"))
    parts = []
    for what, path in paths:
        if os.path.getsize(path) == 0:
            continue
        errors = run(tools, "evaluate_trajectory", reference, path)
        parts.append(f"{what}{1000 * float(errors['ate_rmse_m']):.1f} mm")
    return "ATE: " + ", ".join(parts)


def row(tools, data, name, folder):
    bag, out = os.path.join(data, name + ".bag"), os.path.join(folder, name)
    what, options = KNOWN.get(name, ("", []))
    report = slam(tools, bag, out, options)
    error = "no truth"
    relations, truth = (os.path.join(data, name + end) for end in (".relations", ".gt.tum"))
    if os.path.exists(relations):
        error = relation_errors(tools, relations, bag, out, options)
    elif os.path.exists(truth):
        error = trajectory_errors(tools, truth, bag, out, options, report["images"])
    return [f"`{name}`", what, report["scans"], report["images"],
            f"{report['cpu_ms_per_scan']:.2f}", f"{report['peak_memory_mb']:.0f}",
            report["loop_closures"], error]


def print_row(cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", help="folder with the recordings")
    parser.add_argument("tools", help="folder with the programs")
    parser.add_argument("--out", help="keep maps and trajectories here")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="these recordings alone")
    arguments = parser.parse_args()
    if not os.path.isdir(arguments.data):
        sys.exit(f"recorded_data.py: there is no folder {arguments.data}")
    names = sorted(f[:-len(".bag")] for f in os.listdir(arguments.data) if f.endswith(".bag"))
    if arguments.only:
        missing = sorted(set(arguments.only) - set(names))
        if missing:
            sys.exit(f"recorded_data.py: {arguments.data} has no {missing[0]}.bag")
        names = arguments.only
    if not names:
        sys.exit(f"recorded_data.py: {arguments.data} holds no bag")
    with tempfile.TemporaryDirectory() as scratch:
        print_row(HEAD)
        print_row(["---"] * len(HEAD))
        for name in names:
            print_row(row(arguments.tools, arguments.data, name, arguments.out or scratch))


if __name__ == "__main__":
    try:
        main()
    except (ToolError, OSError) as error:
        print(f"recorded_data.py: {error}", file=sys.stderr)
        sys.exit(2)
