"""What README.md and docs name exists: files, topics, services, parameters, arguments, options; and
the commands that need neither a master nor an installation run as they are written."""
import glob
import os
import re
import subprocess
import unittest
import xml.etree.ElementTree

import yaml

from tools import FOLDER, ToolTest, read, run

SOURCE = os.environ["SCAN_IMAGE_SLAM_SOURCE"]
DOCUMENTS = ["README.md", "docs/architecture.md", "docs/live.md", "docs/migration.md", "docs/paper.md",
             "docs/parameters.md", "config/worlds/README.md"]
NODES = ("scan_image_fusion", "bounded_icp", "mapper")
TOOLS = ["slam_offline", "simulate", "evaluate_trajectory", "evaluate_relations",
         "list_parameters", "reproduce_table1", "coreslam_offline", "calibrate_camera_laser",
         "check_bag", "measure_latency", "soak.py", "evaluate_map"]
ENDINGS = ("md", "rst", "sh", "py", "h", "cpp", "launch", "rviz", "msg", "srv", "test")


def document(name):
    return read(os.path.join(SOURCE, name))


def without_code(text):
    return re.sub(r"```.*?```", "", text, flags=re.DOTALL)


def commands(text):
    """Lines of the shell blocks, without comments."""
    blocks = re.findall(r"```sh\n(.*?)```", text, flags=re.DOTALL)
    lines = [re.sub(r"\s+# .*", "", line).strip() for b in blocks for line in b.splitlines()]
    return [line for line in lines if line]


def spans(text):
    """What is written as code within the text."""
    return re.findall(r"`([^`\n]+)`", without_code(text))


def tables(text):
    """Tables as lists of rows, each a list of cells."""
    rows = []
    for line in without_code(text).splitlines() + [""]:
        if line.startswith("|"):
            rows.append([cell.strip() for cell in line.strip().strip("|").split("|")])
        elif rows:
            yield rows
            rows = []


def flatten(section, prefix):
    for name, value in section.items():
        if isinstance(value, dict):
            yield from flatten(value, prefix + name + "/")
        else:
            yield prefix + name, value


def parameters():
    """Full names and defaults, from the programs' own list."""
    return dict(flatten(yaml.safe_load(run("list_parameters").stdout), ""))


def node_names(kind):
    """Topics or services that the sources of the nodes name."""
    calls = {"topic": r"(?:advertise|subscribe)(?:<[^>]*>)?\(\s*(?:node, )?\"([^\"]+)\"",
             "service": r"(?:advertiseService|files_\.Advertise<[^>]*>)\(\s*\"([^\"]+)\""}
    sources = glob.glob(os.path.join(SOURCE, "src", "ros", "*.cpp"))
    sources += glob.glob(os.path.join(SOURCE, "src", "nodes", "*.cpp"))
    text = "\n".join(read(path) for path in sorted(sources))
    names = set(re.findall(calls[kind], text))
    if kind == "topic":
        names |= set(re.findall(r"trajectory_\(node, \"([^\"]+)\"", text))  # PathPublisher
    return names


def launch_arguments(name):
    tree = xml.etree.ElementTree.parse(os.path.join(SOURCE, "launch", name))
    return {arg.get("name") for arg in tree.getroot().findall("arg") if arg.get("value") is None}


def options_of(tool):
    return set(re.findall(r"--[a-z][a-z-]*", run(tool, "--help").stdout))


class Documents(ToolTest):
    def each(self, items):
        """Checks that the items are there at all, as a pattern that finds nothing checks nothing."""
        items = list(items)
        self.assertTrue(items)
        return items

    def test_links_lead_somewhere(self):
        for name in DOCUMENTS:
            for link in re.findall(r"\]\(([^)#]+)\)", document(name)):
                if link.startswith("http"):
                    continue
                with self.subTest(document=name, link=link):
                    path = os.path.join(SOURCE, os.path.dirname(name), link)
                    self.assertTrue(os.path.exists(path), path)

    def test_files_and_folders_exist(self):
        roots = ["", "launch", "src", "include/scan_image_slam", "include/scan_image_slam/core",
                 "include/scan_image_slam/core/fusion", "include/scan_image_slam/core/simulation"]
        for name in DOCUMENTS:
            for span in spans(document(name)):
                is_file = re.fullmatch(r"[\w/.-]+\.(%s)" % "|".join(ENDINGS), span)
                is_folder = re.match(r"(core|src|include|config|docs|test|scripts)/[\w/.]*$", span)
                if not (is_file or is_folder):
                    continue
                with self.subTest(document=name, path=span):
                    if span == "offline.launch" or span.startswith("core_"):
                        continue
                    self.assertTrue(any(os.path.exists(os.path.join(SOURCE, root, span))
                                        for root in roots))

    def test_parameters_exist_and_have_the_defaults_told(self):
        known = parameters()
        named = set()
        for name in DOCUMENTS:
            for span in spans(document(name)):
                match = re.fullmatch(r"((?:%s)/[a-z_/]*[a-z_])(/\.\.\.|: .*|=.*)?" %
                                     "|".join(NODES), span)
                if not match or span.startswith("mapper/..."):
                    continue
                with self.subTest(document=name, parameter=span):
                    named.add(match.group(1))
                    if match.group(2) == "/...":
                        self.assertTrue(any(p.startswith(match.group(1) + "/") for p in known))
                    else:
                        self.assertIn(match.group(1), known)
        self.assertGreater(len(named), 20)
        rows = self.each(row for table in tables(document("README.md")) for row in table[2:]
                         if table[0][0] == "parameter")
        for cells in rows:
            with self.subTest(parameter=cells[0]):
                self.assertEqual(yaml.safe_load(cells[1]), known[cells[0].strip("`")])

    def test_topics_and_services(self):
        for kind in ("topic", "service"):
            told = set()
            for table in tables(document("README.md")):
                if table[0][1:2] == [kind]:
                    told |= {t for row in table[2:] for t in re.findall(r"`([^`]+)`", row[1])}
            exist = node_names(kind)
            with self.subTest(kind=kind):
                self.assertTrue(told)
                self.assertLessEqual(told, exist, "in the document alone")
                everywhere = {span for span in spans(document("README.md"))}
                self.assertLessEqual(exist - {"tf", "tf_recorded"}, everywhere, "in the nodes alone")

    def test_launch_arguments(self):
        launches = [launch_arguments(os.path.basename(path))
                    for path in glob.glob(os.path.join(SOURCE, "launch", "*.launch"))]
        for name in DOCUMENTS:
            text = document(name)
            lines = commands(text) + [s for s in spans(text) if s.startswith("roslaunch ")]
            for line in lines:
                match = re.match(r"roslaunch scan_image_slam (\S+)(.*)", line)
                if not match:
                    continue
                for argument in re.findall(r"(\w+):=", match.group(2)):
                    with self.subTest(document=name, line=line):
                        self.assertIn(argument, launch_arguments(match.group(1)))
            for span in spans(text):
                match = re.fullmatch(r"([a-z]\w*):=\S*", span)
                if match:
                    with self.subTest(document=name, argument=span):
                        self.assertTrue(any(match.group(1) in known for known in launches))

    def test_options(self):
        options = {tool: options_of(tool) for tool in TOOLS}
        script = subprocess.run([os.path.join(SOURCE, "scripts", "recorded_data.py"), "--help"],
                                stdout=subprocess.PIPE, text=True, check=True)
        others = {"--gtest_filter", "--output-on-failure", "--benchmark_filter", "--loop"}
        anywhere = set().union(others, re.findall(r"--[a-z][a-z-]*", script.stdout),
                               *options.values())
        for name in DOCUMENTS:
            text = document(name)
            for line in commands(text) + spans(text):
                words = line.split()
                tool = next((w for w in words if w in TOOLS), None)
                for option in re.findall(r"(?<!\S)--[a-z][a-z_-]*", line):
                    with self.subTest(document=name, line=line):
                        self.assertIn(option, options[tool] if tool else anywhere)

    def test_every_option_is_in_the_readme(self):
        text = document("README.md")
        for tool in ("slam_offline", "simulate", "evaluate_trajectory", "evaluate_relations",
                     "evaluate_map", "check_bag"):
            for option in options_of(tool) - {"--help"}:
                with self.subTest(tool=tool, option=option):
                    self.assertIn(option, text)

    def test_scripts_of_the_commands_exist(self):
        for name in DOCUMENTS:
            for line in commands(document(name)):
                if line.startswith("scripts/"):
                    path = os.path.join(SOURCE, line.split()[0])
                    self.assertTrue(os.access(path, os.X_OK), line)

    def test_commands_of_the_readme_run_as_written(self):
        """In their order, in one folder, with the programs in the path."""
        lines = self.each(line for line in commands(document("README.md"))
                          if line.split()[0] in TOOLS)
        environment = dict(os.environ, PATH=os.environ["PATH"] + os.pathsep + FOLDER,
                           ROS_MASTER_URI="http://localhost:1")
        for line in lines:
            with self.subTest(line=line):
                result = subprocess.run(line, shell=True, cwd=self.folder, env=environment,
                                        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True, timeout=300)
                self.assertEqual(result.returncode, 0, result.stdout)
        self.assertTrue(os.path.exists(self.path("results", "map.png")))


if __name__ == "__main__":
    unittest.main()
