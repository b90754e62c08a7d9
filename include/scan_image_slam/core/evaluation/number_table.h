#pragma once

#include "scan_image_slam/core/sensor/stamp.h"

#include <istream>
#include <sstream>
#include <string>
#include <vector>

namespace scan_image_slam {

/// Reads a text file of numbers line by line: columns separated by blanks, empty lines and lines
/// that begin with `#` left out. Independent of the locale. Every error is a std::runtime_error
/// that begins with `source:line:`.
class NumberTable {
 public:
  /// `source` is the name of the file for error messages, `columns` are the names of the columns
  /// that every line must have. `input` must outlive the table.
  NumberTable(std::istream& input, std::string source, std::vector<std::string> columns);

  /// Moves on to the next line that holds numbers; false at the end. Throws if the number of
  /// columns is wrong or the file cannot be read.
  bool Next();

  /// Number in this column of the line; throws if it is not a finite number.
  double NumberAt(std::size_t column);

  /// Time in this column of the line, exact to the nanosecond; throws if it is not a time.
  Stamp StampAt(std::size_t column);

  /// Of the line that Next() moved to; the first line of the file is 1.
  std::size_t line_number() const { return line_number_; }

  /// Throws the error `what` about this line.
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  [[noreturn]] void FailAt(std::size_t column, const std::string& what) const;

  std::istream& input_;
  std::string source_;
  std::vector<std::string> columns_;
  std::size_t line_number_ = 0;
  std::vector<std::string> texts_;
  std::istringstream converter_;
};

}  // namespace scan_image_slam
