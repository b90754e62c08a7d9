#include "scan_image_slam/core/evaluation/number_table.h"

#include "scan_image_slam/core/evaluation/stamp_text.h"

#include <algorithm>
#include <cctype>
#include <locale>
#include <optional>
#include <stdexcept>
#include <utility>

namespace scan_image_slam {
namespace {

std::vector<std::string> Split(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> texts;
  for (std::string text; stream >> text;) texts.push_back(text);
  return texts;
}

/// nan, -NaN, inf, +Infinity, ...: numbers for other programs, but not for this one.
bool IsNotFinite(std::string text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.erase(0, 1);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text == "nan" || text == "inf" || text == "infinity";
}

/// Safe to print, whatever kind of file it comes from.
std::string Quote(std::string text) {
  constexpr std::size_t kMaxLength = 40;
  if (text.size() > kMaxLength) text = text.substr(0, kMaxLength) + "...";
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::isprint(c) == 0; }, '?');
  return "'" + text + "'";
}

std::string Join(const std::vector<std::string>& names) {
  std::string joined;
  for (const std::string& name : names) joined += (joined.empty() ? "" : " ") + name;
  return joined;
}

}  // namespace

NumberTable::NumberTable(std::istream& input, std::string source, std::vector<std::string> columns)
    : input_(input), source_(std::move(source)), columns_(std::move(columns)) {
  converter_.imbue(std::locale::classic());
}

bool NumberTable::Next() {
  for (std::string line; std::getline(input_, line);) {
    ++line_number_;
    texts_ = Split(line);
    if (texts_.empty() || texts_.front().front() == '#') continue;
    if (texts_.size() == columns_.size()) return true;
    Fail(std::to_string(texts_.size()) + " columns instead of " + std::to_string(columns_.size()) +
         " (" + Join(columns_) + ")");
  }
  if (input_.bad()) throw std::runtime_error(source_ + ": cannot be read");
  return false;
}

double NumberTable::NumberAt(std::size_t column) {
  const std::string& text = texts_.at(column);
  converter_.clear();
  converter_.str(text);
  double number = 0.0;
  if (converter_ >> number && converter_.peek() == std::istringstream::traits_type::eof()) {
    return number;
  }
  FailAt(column, IsNotFinite(text) ? "is not finite" : "is not a number");
}

Stamp NumberTable::StampAt(std::size_t column) {
  const std::string& text = texts_.at(column);
  const std::optional<Stamp> stamp = ParseStamp(text);
  if (stamp) return *stamp;
  FailAt(column, IsNotFinite(text) ? "is not finite" : "is not a time in seconds");
}

void NumberTable::Fail(const std::string& what) const {
  throw std::runtime_error(source_ + ":" + std::to_string(line_number_) + ": " + what);
}

void NumberTable::FailAt(std::size_t column, const std::string& what) const {
  Fail(columns_.at(column) + " " + Quote(texts_.at(column)) + " " + what);
}

}  // namespace scan_image_slam
