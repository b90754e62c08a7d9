#pragma once

#include "table1_run.h"

#include <string>
#include <vector>

namespace scan_image_slam {

/// Rows of one run, kept in a file so that a cancelled reproduction can go on. `key` tells the
/// settings that the rows were made with; rows with another key are not taken.
void WriteRunFile(const std::string& path, const std::string& key,
                  const std::vector<Table1Row>& rows);
/// Empty if there is no such file or its key is another one.
std::vector<Table1Row> ReadRunFile(const std::string& path, const std::string& key,
                                   const Table1Job& job);

/// Writes table1.csv and table1.md into `folder`. Throws std::runtime_error, naming the file.
void WriteReport(const std::string& folder, const std::string& command,
                 const std::vector<Table1Row>& rows);

}  // namespace scan_image_slam
