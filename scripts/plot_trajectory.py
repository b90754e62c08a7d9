#!/usr/bin/python3
"""Draws trajectories over the map, and their errors over time.

The reference is black, the estimate green, the encoders blue. Everything is drawn in the frame of
the reference, or in the frame of the estimate if there is no reference. Exit codes: 1 wrong usage,
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
    from matplotlib.transforms import Affine2D
except ImportError as missing:
    print(
        "plot_trajectory.py: %s; install it with: sudo apt install python3-matplotlib" % missing,
        file=sys.stderr,
    )
    sys.exit(2)

REFERENCE_COLOUR = "black"
ESTIMATE_COLOUR = "#1a9641"
ENCODER_COLOUR = "#2b7bba"
SAME_TIME = 1e-4  # [s], between poses that count as one moment
UNKNOWN = 205  # grey of map_server for cells nobody has seen


class UnusableInput(Exception):
    """Something in a file that makes a picture impossible."""


class Trajectory:
    """Times [s], positions [m] and headings [rad] as arrays."""

    def __init__(self, time, x, y, yaw):
        self.time, self.x, self.y, self.yaw = time, x, y, yaw

    def moved(self, motion):
        """The same trajectory after the rigid motion (x, y, yaw)."""
        dx, dy, angle = motion
        c, s = np.cos(angle), np.sin(angle)
        return Trajectory(
            self.time,
            dx + c * self.x - s * self.y,
            dy + s * self.x + c * self.y,
            self.yaw + angle,
        )

    def at(self, time, max_gap):
        """Interpolated at these times, and for which of them the trajectory is known."""
        after = np.clip(np.searchsorted(self.time, time), 1, len(self.time) - 1)
        inside = (time >= self.time[0]) & (time <= self.time[-1])
        between = inside & (self.time[after] - self.time[after - 1] <= max_gap)
        distance = np.minimum(np.abs(self.time[after] - time), np.abs(self.time[after - 1] - time))
        yaw = np.unwrap(self.yaw)
        interpolated = Trajectory(
            time,
            np.interp(time, self.time, self.x),
            np.interp(time, self.time, self.y),
            np.interp(time, self.time, yaw),
        )
        return interpolated, between | (distance <= SAME_TIME)

    def only(self, chosen):
        return Trajectory(self.time[chosen], self.x[chosen], self.y[chosen], self.yaw[chosen])


def read_tum(path):
    rows = []
    with open(path, encoding="utf-8", errors="replace") as lines:
        for number, line in enumerate(lines, 1):
            words = line.split()
            if not words or words[0].startswith("#"):
                continue
            if len(words) != 8:
                raise UnusableInput("%s:%d: %d columns instead of 8" % (path, number, len(words)))
            try:
                rows.append([float(word) for word in words])
            except ValueError as error:
                raise UnusableInput("%s:%d: %s" % (path, number, error))
    if len(rows) < 2:
        raise UnusableInput("%s: holds %d poses, two are needed" % (path, len(rows)))
    time, x, y, _, qx, qy, qz, qw = np.array(rows).T
    if not (np.all(np.isfinite(rows)) and np.all(np.diff(time) > 0)):
        raise UnusableInput("%s: values that are not finite or times that do not increase" % path)
    yaw = np.arctan2(2 * (qw * qz + qx * qy), qw**2 + qx**2 - qy**2 - qz**2)
    return Trajectory(time, x, y, yaw)


def wrapped(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def best_angle(truth, estimate):
    px, py = estimate.x - estimate.x.mean(), estimate.y - estimate.y.mean()
    qx, qy = truth.x - truth.x.mean(), truth.y - truth.y.mean()
    dot, cross = np.sum(px * qx + py * qy), np.sum(px * qy - py * qx)
    if np.hypot(dot, cross) < 1e-12:  # stands still: the headings decide
        difference = truth.yaw - estimate.yaw
        return np.arctan2(np.sin(difference).sum(), np.cos(difference).sum())
    return np.arctan2(cross, dot)


def alignment(truth, estimate, how):
    """Motion (x, y, yaw) that carries the estimate onto the truth; both at the same times."""
    if how == "none":
        return 0.0, 0.0, 0.0
    if how == "first":
        angle = truth.yaw[0] - estimate.yaw[0]
        fixed, target = (estimate.x[0], estimate.y[0]), (truth.x[0], truth.y[0])
    else:
        angle = best_angle(truth, estimate)
        fixed, target = (estimate.x.mean(), estimate.y.mean()), (truth.x.mean(), truth.y.mean())
    c, s = np.cos(angle), np.sin(angle)
    return (
        target[0] - c * fixed[0] + s * fixed[1],
        target[1] - s * fixed[0] - c * fixed[1],
        angle,
    )


def align(truth, estimate, how, max_gap, name):
    """The alignment, and the matching poses of truth and aligned estimate."""
    at_estimate, known = truth.at(estimate.time, max_gap)
    if np.count_nonzero(known) < 2:
        raise UnusableInput("%s: fewer than two poses at times of the reference" % name)
    at_estimate, matched = at_estimate.only(known), estimate.only(known)
    motion = alignment(at_estimate, matched, how)
    return motion, at_estimate, matched.moved(motion)


def read_pgm(path):
    """Grey values of a binary PGM file; plain numpy, because matplotlib needs another package."""
    with open(path, "rb") as stream:
        data = stream.read()
    header, position = [], 0
    while len(header) < 4:
        end = data.find(b"\n", position)
        if end < 0:
            raise UnusableInput("%s: the header is incomplete" % path)
        header += data[position:end].split(b"#")[0].split()
        position = end + 1
    if header[0] != b"P5" or header[3] != b"255":
        raise UnusableInput("%s: not a binary PGM file with 255 grey values" % path)
    width, height = int(header[1]), int(header[2])
    if len(data) - position < width * height:
        raise UnusableInput("%s: shorter than its header says" % path)
    return np.frombuffer(data, np.uint8, width * height, position).reshape(height, width)


def read_map(path):
    """Grey values, resolution [m] and origin (x, y, yaw) of a map of map_server."""
    with open(path, encoding="utf-8", errors="replace") as lines:
        pairs = [line.split("#")[0].split(":", 1) for line in lines if ":" in line.split("#")[0]]
    values = {key.strip(): value.strip().strip("\"'") for key, value in pairs}
    try:
        origin = [float(word) for word in values["origin"].strip("[]").split(",")]
        resolution, image = float(values["resolution"]), values["image"]
        negate = int(values.get("negate", "0"))
    except (KeyError, ValueError) as error:
        raise UnusableInput("%s: %s is missing or wrong" % (path, error))
    grey = read_pgm(os.path.join(os.path.dirname(path), image))
    return (255 - grey if negate else grey), resolution, origin


def draw_map(axes, path, motion):
    grey, resolution, (origin_x, origin_y, origin_yaw) = read_map(path)
    height, width = grey.shape
    extent = [0, width * resolution, 0, height * resolution]
    placed = Affine2D().rotate(origin_yaw).translate(origin_x, origin_y)
    placed = placed.rotate(motion[2]).translate(motion[0], motion[1])
    known = np.ma.masked_equal(grey, UNKNOWN)
    shades = {"cmap": "gray", "vmin": -80, "vmax": 255}  # dark grey walls, so that black shows
    picture = axes.imshow(known, extent=extent, interpolation="nearest", zorder=0, **shades)
    picture.set_transform(placed + axes.transData)
    axes.set_facecolor(picture.cmap(picture.norm(UNKNOWN)))
    rows, columns = np.nonzero(grey != UNKNOWN)
    if not rows.size:
        return
    left, right = columns.min() * resolution, (columns.max() + 1) * resolution
    bottom, top = (height - 1 - rows.max()) * resolution, (height - rows.min()) * resolution
    corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
    axes.update_datalim(placed.transform(corners))


def draw_path(axes, trajectory, colour, label, zorder, width=1.3):
    axes.plot(trajectory.x, trajectory.y, color=colour, label=label, lw=width, zorder=zorder)
    axes.plot(trajectory.x[0], trajectory.y[0], "o", color=colour, ms=5, zorder=zorder)


def draw_errors(position_axes, heading_axes, truth, estimate, start, colour, label):
    """Distance and heading error over time, at the times of the estimate."""
    distance = np.hypot(truth.x - estimate.x, truth.y - estimate.y)
    heading = np.degrees(np.abs(wrapped(truth.yaw - estimate.yaw)))
    rms = np.sqrt(np.mean(distance**2))
    time = truth.time - start
    label = "%s: rms %.4f m, max %.4f m" % (label, rms, distance.max())
    position_axes.plot(time, distance, color=colour, lw=1.0, label=label)
    label = "rms %.3f°, max %.3f°" % (np.sqrt(np.mean(heading**2)), heading.max())
    heading_axes.plot(time, heading, color=colour, lw=1.0, label=label)


def make_axes(with_errors):
    if not with_errors:
        figure, axes = plt.subplots(figsize=(9, 8))
        return figure, axes, None, None
    figure = plt.figure(figsize=(15, 8))
    grid = figure.add_gridspec(2, 2, width_ratios=[3, 2])
    position = figure.add_subplot(grid[0, 1])
    heading = figure.add_subplot(grid[1, 1], sharex=position)
    return figure, figure.add_subplot(grid[:, 0]), position, heading


def finish_path_axes(axes):
    axes.autoscale_view()
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.grid(True, lw=0.3)
    axes.legend(loc="best")


def finish_error_axes(position, heading, logarithmic):
    position.set_ylabel("position error [m]")
    heading.set_ylabel("heading error [°]")
    heading.set_xlabel("time [s]")
    for axes, least in ((position, 1e-4), (heading, 1e-3)):
        if logarithmic:  # the encoders are worse by orders of magnitude
            axes.set_yscale("log")
            axes.set_ylim(bottom=max(least, axes.get_ylim()[0]))
        else:
            axes.set_ylim(bottom=0)
        axes.grid(True, which="both", lw=0.3)
        axes.legend(loc="best", fontsize="small")


def draw(options):
    estimate = read_tum(options.estimate)
    encoder = read_tum(options.encoder) if options.encoder else None
    reference = read_tum(options.reference) if options.reference else None
    figure, paths, position, heading = make_axes(reference is not None)
    start = estimate.time[0]
    motion = (0.0, 0.0, 0.0)
    if reference is not None:
        draw_path(paths, reference, REFERENCE_COLOUR, "reference", 3, width=3.5)
        motion, truth, matched = align(
            reference, estimate, options.align, options.max_gap, options.estimate
        )
        draw_errors(position, heading, truth, matched, start, ESTIMATE_COLOUR, "estimate")
    draw_path(paths, estimate.moved(motion), ESTIMATE_COLOUR, "estimate", 4)
    if encoder is not None:
        truth = reference if reference is not None else estimate
        encoder_motion, truth, matched = align(
            truth, encoder, options.align, options.max_gap, options.encoder
        )
        draw_path(paths, encoder.moved(encoder_motion), ENCODER_COLOUR, "encoders", 2)
        if reference is not None:
            draw_errors(position, heading, truth, matched, start, ENCODER_COLOUR, "encoders")
    if options.map:
        draw_map(paths, options.map, motion)
    finish_path_axes(paths)
    if reference is not None:
        finish_error_axes(position, heading, encoder is not None)
    figure.tight_layout()
    figure.savefig(options.out, dpi=120)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.print_usage(sys.stderr)
        self.exit(1, "%s: %s\n" % (self.prog, message))


def parse_arguments():
    parser = Parser(description="Draws trajectories (TUM format) and their errors over time.")
    parser.add_argument("--estimate", required=True, help="trajectory of the SLAM, green")
    parser.add_argument("--out", required=True, help="picture to write, e.g. run.png")
    parser.add_argument("--reference", help="true trajectory, black; none: no errors")
    parser.add_argument("--encoder", help="dead reckoning, blue")
    parser.add_argument("--map", help="map.yaml in the frame of the estimate, drawn underneath")
    parser.add_argument("--align", choices=("first", "best", "none"), default="first")
    parser.add_argument(
        "--max-gap", type=float, default=0.25, help="longest gap that is interpolated [s]"
    )
    return parser.parse_args()


def main():
    options = parse_arguments()
    try:
        draw(options)
    except (UnusableInput, OSError, ValueError) as error:
        print("plot_trajectory.py: %s" % error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
