#include "scan_image_slam/core/evaluation/key_values.h"

#include <cmath>
#include <iomanip>
#include <locale>

namespace scan_image_slam {

KeyValues::KeyValues() {
  text_.imbue(std::locale::classic());
  text_ << std::fixed << std::setprecision(6);
}

KeyValues& KeyValues::Add(const std::string& key, double value) {
  std::ostream& text = Begin(key);
  if (std::isnan(value)) {
    text << "nan";  // never "-nan"
  } else {
    text << value;
  }
  return *this;
}

KeyValues& KeyValues::Add(const std::string& key, std::size_t value) {
  Begin(key) << value;
  return *this;
}

std::ostream& KeyValues::Begin(const std::string& key) {
  if (text_.tellp() > 0) text_ << ' ';
  return text_ << key << '=';
}

}  // namespace scan_image_slam
