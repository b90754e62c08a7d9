#include "scan_image_slam/core/config/parameter_reference.h"

#include "scan_image_slam/core/config/foreign_names.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(ParameterReference, HasALineForEachParameter) {
  double width = 0.5;
  bool dry = true;
  std::string colour = "red";
  ParameterSet set("painter");
  set.Add("brush/width", &width, "m", {0.5, 2.0}, "a length");
  set.Add("dry", &dry, "a switch");
  set.Add("colour", &colour, "a name");
  set.AllowLive({"dry"});
  const std::string text = WriteReference({set});
  EXPECT_NE(text.find("\n## painter\n\n"
                      "| name | type | default | unit | range | live | meaning |\n"
                      "| --- | --- | --- | --- | --- | --- | --- |\n"
                      "| `brush/width` | double | 0.5 | m | 0.5 to 2.0 | | a length |\n"
                      "| `dry` | bool | true | | | live | a switch |\n"
                      "| `colour` | string | red | | | | a name |\n\n"),
            std::string::npos)
      << text;
}

TEST(ParameterReference, HasALineForEachNameOfOtherPackages) {
  const std::string text = WriteReference({});
  EXPECT_NE(text.find("| `delta` | gmapping | `mapper/resolution` | |\n"), std::string::npos);
  for (const ForeignName& foreign : ForeignNames()) {
    EXPECT_NE(text.find("\n| `" + foreign.name + "` |"), std::string::npos) << foreign.name;
  }
}

}  // namespace
}  // namespace scan_image_slam
