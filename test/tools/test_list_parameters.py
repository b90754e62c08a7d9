"""list_parameters prints what config/default.yaml and docs/parameters.md hold."""
import os
import unittest

import yaml

from tools import ToolTest, read, run

SOURCE = os.environ["SCAN_IMAGE_SLAM_SOURCE"]
DEFAULT = os.path.join(SOURCE, "config", "default.yaml")
REFERENCE = os.path.join(SOURCE, "docs", "parameters.md")


class ListParameters(ToolTest):
    def test_prints_the_default_configuration(self):
        result = run("list_parameters")
        self.expect(result, 0)
        self.assertEqual(result.stdout, read(DEFAULT))

    def test_prints_the_reference(self):
        result = run("list_parameters", "--markdown")
        self.expect(result, 0)
        self.assertEqual(result.stdout, read(REFERENCE))

    def test_is_yaml_with_a_section_for_each_node(self):
        sections = yaml.safe_load(run("list_parameters").stdout)
        self.assertEqual(set(sections), {"scan_image_fusion", "bounded_icp", "mapper"})
        self.assertEqual(sections["mapper"]["map_frame"], "map")


if __name__ == "__main__":
    unittest.main()
