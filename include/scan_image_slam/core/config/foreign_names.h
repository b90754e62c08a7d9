#pragma once

#include <string>
#include <vector>

namespace scan_image_slam {

/// A parameter as users of other packages know it, and what does the same here.
struct ForeignName {
  std::string name;
  std::string packages;           ///< where it is known from
  std::vector<std::string> here;  ///< full names, e.g. mapper/resolution; empty: there is none
  std::string remark;             ///< what to do instead, or what is different
};

/// All that are known, in the order of the alphabet.
const std::vector<ForeignName>& ForeignNames();

/// Null if the name is not known from anywhere.
const ForeignName* FindForeignName(const std::string& name);

/// One sentence for who has used it: where the name is from, and what to use.
std::string Explain(const ForeignName& foreign);

}  // namespace scan_image_slam
