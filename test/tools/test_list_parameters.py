"""list_parameters prints what config/default.yaml holds, and slam_offline takes it back."""
import os
import unittest

import yaml

from tools import ToolTest, read, run

DEFAULT = os.path.join(os.environ["SCAN_IMAGE_SLAM_SOURCE"], "config", "default.yaml")


class ListParameters(ToolTest):
    def test_prints_the_default_configuration(self):
        result = run("list_parameters")
        self.expect(result, 0)
        self.assertEqual(result.stdout, read(DEFAULT))

    def test_is_yaml_with_a_section_for_each_node(self):
        sections = yaml.safe_load(run("list_parameters").stdout)
        self.assertEqual(set(sections), {"scan_image_fusion", "bounded_icp", "mapper"})
        self.assertEqual(sections["mapper"]["map_frame"], "map")


if __name__ == "__main__":
    unittest.main()
