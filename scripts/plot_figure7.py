#!/usr/bin/python3
"""The paper's Fig. 7 of any run: points and way by the estimate (red, green) and by the encoders alone
(blue, black).

Needs the bag and the folder that slam_offline has written for it. Exit codes: 1 wrong usage,
2 unusable input or a package that is missing.
"""
import argparse
import os
import sys

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
    import rosbag
except ImportError as missing:
    print(
        "plot_figure7.py: %s; scripts/setup.sh installs what it needs" % missing, file=sys.stderr
    )
    sys.exit(2)

from plot_trajectory import UnusableInput, read_tum

ESTIMATE = {"cloud": "#d62728", "way": "#1a9641"}
ENCODERS = {"cloud": "#2b5fba", "way": "black"}


def yaw_of(q):
    return np.arctan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))


def read_mounts(bag):
    """Pose (x, y, yaw, upside down) in its parent frame of each frame that does not move."""
    mounts = {}
    for _, message, _ in bag.read_messages(topics=["/tf_static"]):
        for transform in message.transforms:
            q, t = transform.transform.rotation, transform.transform.translation
            upside_down = 1 - 2 * (q.x**2 + q.y**2) < 0
            mounts[transform.child_frame_id] = (t.x, t.y, yaw_of(q), upside_down)
    return mounts


def read_scans(path, topic, every):
    """Times of the beams and their hits in the base frame, of every so many scans."""
    with rosbag.Bag(path) as bag:
        mounts = read_mounts(bag)
        for number, (_, scan, _) in enumerate(bag.read_messages(topics=[topic])):
            if number % every:
                continue
            x, y, yaw, upside_down = mounts.get(scan.header.frame_id, (0.0, 0.0, 0.0, False))
            ranges = np.array(scan.ranges)
            beams = np.arange(len(ranges))
            with np.errstate(invalid="ignore"):
                hit = (ranges >= scan.range_min) & (ranges <= scan.range_max)
            bearing = scan.angle_min + beams * scan.angle_increment
            heading = (yaw + (-bearing if upside_down else bearing))[hit]
            time = scan.header.stamp.to_sec() + (beams * scan.time_increment)[hit]
            points = ranges[hit] * np.array([np.cos(heading), np.sin(heading)])
            yield time, points + np.array([[x], [y]])


def cloud(trajectory, scans):
    """All hits, each moved by where the base was when its beam was fired."""
    yaw = np.unwrap(trajectory.yaw)
    parts = []
    for time, points in scans:
        inside = (time >= trajectory.time[0]) & (time <= trajectory.time[-1])
        time, points = time[inside], points[:, inside]
        angle = np.interp(time, trajectory.time, yaw)
        c, s = np.cos(angle), np.sin(angle)
        parts.append(
            np.array(
                [
                    np.interp(time, trajectory.time, trajectory.x) + c * points[0] - s * points[1],
                    np.interp(time, trajectory.time, trajectory.y) + s * points[0] + c * points[1],
                ]
            )
        )
    if not parts or not any(part.size for part in parts):
        raise UnusableInput("no scan lies within the time of the trajectory")
    return np.hstack(parts)


def start_together(estimate, encoders):
    """The encoders' way, moved so that both start at the same pose."""
    angle = estimate.yaw[0] - encoders.yaw[0]
    c, s = np.cos(angle), np.sin(angle)
    dx = estimate.x[0] - (c * encoders.x[0] - s * encoders.y[0])
    dy = estimate.y[0] - (s * encoders.x[0] + c * encoders.y[0])
    return encoders.moved((dx, dy, angle))


def draw_run(axes, points, trajectory, colours, name):
    # Single pixels: small files, and thin walls where the points agree.
    axes.plot(points[0], points[1], ",", color=colours["cloud"], antialiased=False)
    axes.plot(trajectory.x, trajectory.y, color=colours["way"], lw=1.6, label="way, " + name)
    axes.plot([], [], ".", ms=6, color=colours["cloud"], label="laser points, " + name)
    axes.plot(trajectory.x[-1], trajectory.y[-1], "o", ms=8, mfc="none", mec=colours["cloud"], mew=2)


def draw(options):
    estimate = read_tum(os.path.join(options.run, "trajectory.tum"))
    encoders = read_tum(os.path.join(options.run, "encoder.tum"))
    encoders = start_together(estimate, encoders)
    scans = list(read_scans(options.bag, options.scan_topic, options.every))
    if not scans:
        raise UnusableInput("%s: no scans on topic %s" % (options.bag, options.scan_topic))
    runs = [
        (cloud(estimate, scans), estimate, ESTIMATE, "estimate"),
        (cloud(encoders, scans), encoders, ENCODERS, "encoders"),
    ]
    figure, all_axes = plt.subplots(1, 3, figsize=(15, 5), sharex=True, sharey=True)
    panels = (("(a) estimate", runs[:1]), ("(b) encoders", runs[1:]), ("(c) both", runs[::-1]))
    for axes, (title, shown) in zip(all_axes, panels):
        for run in shown:
            draw_run(axes, *run)
        axes.set_aspect("equal")
        axes.set_title(title)
        axes.set_xlabel("x [m]")
        axes.grid(True, lw=0.3)
        axes.legend(loc="upper right", fontsize="x-small")
    all_axes[0].set_ylabel("y [m]")
    figure.tight_layout()
    figure.savefig(options.out, dpi=80)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.print_usage(sys.stderr)
        self.exit(1, "%s: %s\n" % (self.prog, message))


def parse_arguments():
    parser = Parser(description="Draws the paper's Fig. 7 of a run of slam_offline.")
    parser.add_argument("--bag", required=True, help="the bag that was run")
    parser.add_argument("--run", required=True, help="the folder that slam_offline has written")
    parser.add_argument("--out", required=True, help="picture to write, e.g. figure7.png")
    parser.add_argument("--scan-topic", default="/scan")
    parser.add_argument("--every", type=int, default=60, help="draw every so many scans")
    options = parser.parse_args()
    if options.every < 1:
        parser.error("--every must be at least 1")
    return options


def main():
    options = parse_arguments()
    try:
        draw(options)
    except (UnusableInput, OSError, ValueError, rosbag.ROSBagException) as error:
        print("plot_figure7.py: %s" % error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
