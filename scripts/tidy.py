#!/usr/bin/python3
"""Runs clang-tidy on all sources, with the flags that a build folder tells.

Most of its time goes into the headers of other packages. So the sources of one folder are read at once,
as if they were one; only programs, each with a main() of its own, are read alone. What it finds is told
at the places where it stands. Exit code 1 if it finds anything.
"""
import argparse
import json
import os
import subprocess
import sys

REPOSITORY = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TOGETHER = ("src/core", "src/ros", "src/rviz")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", help="folder that the package was built in")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    with open(os.path.join(arguments.build, "compile_commands.json")) as file:
        commands = json.load(file)
    out = os.path.join(os.path.abspath(arguments.build), "tidy")
    os.makedirs(out, exist_ok=True)
    units = {}  # by file: its command, and the sources that it stands for
    for entry in commands:
        source = os.path.relpath(entry["file"], REPOSITORY)
        if not source.startswith(("src/", "bench/")):
            continue
        unit = source
        if source.startswith(TOGETHER):
            unit = os.path.dirname(source).replace("/", "_") + ".cpp"
        _, sources = units.setdefault(unit, (entry, []))
        sources.append(entry["file"])
    database = []
    for unit, (entry, sources) in sorted(units.items()):
        path = entry["file"]
        if len(sources) > 1:
            path = os.path.join(out, unit)
            with open(path, "w") as file:
                file.writelines('#include "%s"\n' % source for source in sorted(set(sources)))
        command = entry["command"].replace(entry["file"], path)
        database.append({"directory": entry["directory"], "file": path, "command": command})
    with open(os.path.join(out, "compile_commands.json"), "w") as file:
        json.dump(database, file)
    return subprocess.run(["run-clang-tidy", "-quiet", "-j", str(arguments.jobs), "-p", out],
                          stderr=subprocess.DEVNULL).returncode


if __name__ == "__main__":
    sys.exit(main())
