// Any file that is said to be a bag: refused, or read and mapped to finite poses.

#include "bag_commands.h"
#include "bag_contents.h"
#include "bag_plan.h"
#include "bag_report.h"
#include "fuzz_file.h"
#include "scan_image_slam/ros/bag_input.h"

namespace scan_image_slam {
namespace {

void Expect(const PipelineResult& result) { Require(IsFinite(result.pose.map_from_base)); }

}  // namespace
}  // namespace scan_image_slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  static const rosbag::Bag kBag;  // keeps the plugin that each bag loads
  const FuzzFile file(data, size);
  try {
    BagInput input(file.path(), BagTopics(), SlamOptions());
    SlamPipeline pipeline(SlamOptions(), Expect);
    const auto run = [](Stage, const std::function<void()>& work) { work(); };
    input.Play(&pipeline, run, [](double) {});
  } catch (const BagError&) {
  }
  try {
    const BagContents contents = ReadBagContents(file.path(), [](double) {});
    const BagPlan plan = MakeBagPlan(contents, BagTopics());
    Require(!DescribeContents(contents, plan).empty());
    FindingsText(CheckContents(contents, plan));
    CommandLines(contents, plan, "slam_offline");
  } catch (const BagError&) {
  }
  return 0;
}
