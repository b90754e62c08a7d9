#pragma once

#include <cstddef>
#include <sstream>
#include <string>

namespace scan_image_slam {

/// One line `key=value key=value ...` for people and scripts, the same in every locale. Numbers
/// have six decimals, a value that does not exist is `nan`.
class KeyValues {
 public:
  KeyValues();
  KeyValues& Add(const std::string& key, double value);
  KeyValues& Add(const std::string& key, std::size_t value);
  std::string Line() const { return text_.str(); }

 private:
  std::ostream& Begin(const std::string& key);

  std::ostringstream text_;
};

}  // namespace scan_image_slam
