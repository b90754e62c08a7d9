#include "table1_report.h"

#include "scan_image_slam/core/evaluation/statistics.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace scan_image_slam {
namespace {

constexpr double kDegrees = Degrees(1.0);  // in a radian

void WriteFile(const std::string& path, const std::string& text) {
  // Written beside and moved: a cancelled run leaves no half a file.
  const std::string unfinished = path + ".tmp";
  std::ofstream file(unfinished);
  file << text;
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(unfinished, path, error);
  if (!file || error) throw std::runtime_error("can't write " + path);
}

std::string ToCsv(const std::vector<Table1Row>& rows) {
  std::ostringstream csv;
  csv << "map,seed,sensors,method,config,error_px,error_m,yaw_deg,fps\n" << std::setprecision(8);
  for (const Table1Row& row : rows) {
    csv << row.job.map << ',' << row.job.seed << ',' << row.job.sensors << ',' << row.method << ','
        << row.config << ',' << row.error / kPixel << ',' << row.error << ',' << row.yaw * kDegrees
        << ',' << row.fps << '\n';
  }
  return csv.str();
}

/// The different values of a field, in the order of their first occurrence.
std::vector<std::string> Values(const std::vector<Table1Row>& rows,
                                const std::function<std::string(const Table1Row&)>& field) {
  std::vector<std::string> values;
  for (const Table1Row& row : rows) {
    if (std::find(values.begin(), values.end(), field(row)) == values.end()) {
      values.push_back(field(row));
    }
  }
  return values;
}

std::string MethodOf(const Table1Row& row) {
  return row.method == "coreslam" ? "CoreSLAM" : "proposed, " + row.config;
}
std::string MapOf(const Table1Row& row) { return row.job.map; }
std::string SensorsOf(const Table1Row& row) { return row.job.sensors; }

std::vector<Table1Row> Only(const std::vector<Table1Row>& rows,
                            const std::function<std::string(const Table1Row&)>& field,
                            const std::string& value) {
  std::vector<Table1Row> chosen;
  for (const Table1Row& row : rows) {
    if (field(row) == value) chosen.push_back(row);
  }
  return chosen;
}

Statistics Summarize(const std::vector<Table1Row>& rows, double Table1Row::*field, double scale) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const Table1Row& row : rows) values.push_back(scale * row.*field);
  return scan_image_slam::Summarize(values);
}

/// `value` with as many decimals as make four digits, but at most five.
std::string Text(double value) {
  const int digits = value >= 100.0 ? 0 : (value >= 10.0 ? 1 : (value >= 1.0 ? 2 : 5));
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

/// The paper's table: all maps together.
std::string MainTable(const std::vector<Table1Row>& rows) {
  const double core_slam = Summarize(Only(rows, MethodOf, "CoreSLAM"), &Table1Row::error, 1.0).mean;
  std::ostringstream table;
  table << "| method | error [px] | error [m] | heading error [deg] | FPS | error of CoreSLAM / "
           "error |\n| --- | --- | --- | --- | --- | --- |\n";
  for (const std::string& method : Values(rows, MethodOf)) {
    const std::vector<Table1Row> its = Only(rows, MethodOf, method);
    const double error = Summarize(its, &Table1Row::error, 1.0).mean;
    table << "| " << method << " | " << Text(error / kPixel) << " | " << Text(error) << " | "
          << Text(Summarize(its, &Table1Row::yaw, kDegrees).mean) << " | "
          << Text(Summarize(its, &Table1Row::fps, 1.0).mean) << " | " << Text(core_slam / error)
          << " |\n";
  }
  return table.str();
}

/// Error [px], mean and standard deviation over the seeds: a line for each map.
std::string MapTable(const std::vector<Table1Row>& rows) {
  const std::vector<std::string> methods = Values(rows, MethodOf);
  std::ostringstream table;
  std::string rule = "| --- |";
  table << "| map |";
  for (const std::string& method : methods) {
    table << " " << method << " |";
    rule += " --- |";
  }
  table << "\n" << rule << "\n";
  for (const std::string& map : Values(rows, MapOf)) {
    const std::vector<Table1Row> its = Only(rows, MapOf, map);
    table << "| " << map << " |";
    for (const std::string& method : methods) {
      const Statistics error =
          Summarize(Only(its, MethodOf, method), &Table1Row::error, 1.0 / kPixel);
      table << " " << Text(error.mean) << " ± " << Text(error.standard_deviation) << " |";
    }
    table << "\n";
  }
  return table.str();
}

std::string ToMarkdown(const std::string& command, const std::vector<Table1Row>& rows) {
  std::ostringstream text;
  text << "Made by `" << command << "`. Error: mean distance between estimated and true position, "
       << "with the first poses made to coincide; a pixel is " << 100.0 * kPixel
       << " cm. FPS: scans per second of processor time of the whole method, with the image "
          "processing. The paper has 0.00409 px at 38.5 FPS, and for CoreSLAM 0.05522 px at 37 "
          "FPS.\n";
  for (const std::string& sensors : Values(rows, SensorsOf)) {
    const std::vector<Table1Row> its = Only(rows, SensorsOf, sensors);
    text << "\n## Sensors: " << sensors << "\n\n"
         << MainTable(its) << "\nError in pixels by map, mean ± standard deviation over the "
         << "seeds:\n\n"
         << MapTable(its);
  }
  return text.str();
}

}  // namespace

void WriteRunFile(const std::string& path, const std::string& key,
                  const std::vector<Table1Row>& rows) {
  WriteFile(path, "# " + key + "\n" + ToCsv(rows));
}

std::vector<Table1Row> ReadRunFile(const std::string& path, const std::string& key,
                                   const Table1Job& job) {
  std::ifstream file(path);
  std::string line;
  std::vector<Table1Row> rows;
  if (!std::getline(file, line) || line != "# " + key || !std::getline(file, line)) return rows;
  while (std::getline(file, line)) {
    std::vector<std::string> words;
    std::istringstream stream(line);
    for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
    if (words.size() != 9) return {};
    rows.push_back({job, words[3], words[4], std::stod(words[6]), std::stod(words[7]) / kDegrees,
                    std::stod(words[8])});
  }
  return rows;
}

void WriteReport(const std::string& folder, const std::string& command,
                 const std::vector<Table1Row>& rows) {
  WriteFile(folder + "/table1.csv", ToCsv(rows));
  WriteFile(folder + "/table1.md", ToMarkdown(command, rows));
}

}  // namespace scan_image_slam
