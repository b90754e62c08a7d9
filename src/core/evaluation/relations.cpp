#include "scan_image_slam/core/evaluation/relations.h"

#include "scan_image_slam/core/evaluation/key_values.h"
#include "scan_image_slam/core/evaluation/number_table.h"
#include "scan_image_slam/core/evaluation/stamp_text.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>

namespace scan_image_slam {
namespace {

Relation ReadRelation(NumberTable& table) {
  Relation relation;
  relation.first = table.StampAt(0);
  relation.second = table.StampAt(1);
  relation.first_from_second.x = table.NumberAt(2);
  relation.first_from_second.y = table.NumberAt(3);
  for (const std::size_t column : {4, 5, 6}) table.NumberAt(column);  // must be numbers, too
  relation.first_from_second.theta = NormalizeAngle(table.NumberAt(7));
  return relation;
}

/// d^-1 d*, or nothing if the trajectory does not know both moments.
std::optional<Pose2> RelationError(const Relation& relation, const Trajectory& estimate,
                                   const LookupLimits& limits) {
  const std::optional<Pose2> first = PoseAt(estimate, relation.first, limits);
  const std::optional<Pose2> second = PoseAt(estimate, relation.second, limits);
  if (!first || !second) return std::nullopt;
  const Pose2 estimated_motion = first->Inverse() * *second;
  return estimated_motion.Inverse() * relation.first_from_second;
}

std::string DescribeSpan(const std::vector<Relation>& relations) {
  if (relations.empty()) return "without relations";
  Stamp begin = relations.front().first;
  Stamp end = begin;
  for (const Relation& relation : relations) {
    begin = std::min({begin, relation.first, relation.second});
    end = std::max({end, relation.first, relation.second});
  }
  return "from " + FormatStamp(begin) + " to " + FormatStamp(end);
}

}  // namespace

std::vector<Relation> ReadRelations(std::istream& input, const std::string& source) {
  NumberTable table(input, source, {"time1", "time2", "x", "y", "z", "roll", "pitch", "yaw"});
  std::vector<Relation> relations;
  while (table.Next()) relations.push_back(ReadRelation(table));
  if (relations.empty()) throw std::runtime_error(source + ": holds no relations");
  return relations;
}

std::vector<Relation> ReadRelationsFile(const std::string& path) {
  std::ifstream input(path);
  if (!input) throw std::runtime_error("cannot open " + path + ": " + std::strerror(errno));
  return ReadRelations(input, path);
}

RelationErrors EvaluateRelations(const std::vector<Relation>& relations, const Trajectory& estimate,
                                 const RelationErrorOptions& options) {
  options.lookup.Validate();
  std::vector<double> translation;
  std::vector<double> rotation;
  for (const Relation& relation : relations) {
    const std::optional<Pose2> error = RelationError(relation, estimate, options.lookup);
    if (!error) continue;
    translation.push_back(error->translation().norm());
    rotation.push_back(std::abs(error->theta));
  }
  if (translation.empty()) {
    throw std::runtime_error("no relation has both its times in the estimate: the relations go " +
                             DescribeSpan(relations) + ", the estimate " + DescribeSpan(estimate));
  }
  return {relations.size(), translation.size(), Summarize(translation), Summarize(rotation)};
}

std::string ToKeyValues(const RelationErrors& errors) {
  const double rotation_rms = Degrees(errors.rotation.rms);
  KeyValues line;
  line.Add("relations", errors.relations)
      .Add("used", errors.used)
      .Add("trans_mean_m", errors.translation.mean)
      .Add("trans_std_m", errors.translation.standard_deviation)
      .Add("trans_median_m", errors.translation.median)
      .Add("trans_max_m", errors.translation.max)
      .Add("trans_sqr_mean_m2", errors.translation.rms * errors.translation.rms)
      .Add("rot_mean_deg", Degrees(errors.rotation.mean))
      .Add("rot_std_deg", Degrees(errors.rotation.standard_deviation))
      .Add("rot_median_deg", Degrees(errors.rotation.median))
      .Add("rot_max_deg", Degrees(errors.rotation.max))
      .Add("rot_sqr_mean_deg2", rotation_rms * rotation_rms);
  return line.Line();
}

}  // namespace scan_image_slam
