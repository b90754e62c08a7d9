#include "scan_image_slam/core/config/parameter_reference.h"

#include "scan_image_slam/core/config/foreign_names.h"

namespace scan_image_slam {
namespace {

std::string Code(const std::string& text) { return "`" + text + "`"; }

std::string Row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += (cell.empty() ? "" : " " + cell) + " |";
  return row + "\n";
}

std::string Head(const std::vector<std::string>& titles) {
  return Row(titles) + Row(std::vector<std::string>(titles.size(), "---"));
}

std::string Default(const Parameter& p) {
  const ParameterValue value = p.get();
  const std::string* text = std::get_if<std::string>(&value);
  return text != nullptr ? *text : ToText(value);
}

std::string NodeTable(const ParameterSet& set) {
  std::string text = Head({"name", "type", "default", "unit", "range", "live", "meaning"});
  for (const Parameter& p : set.parameters()) {
    text += Row({Code(p.name), p.type, Default(p), p.unit == "-" ? "" : p.unit, RangeText(p),
                 p.live ? "live" : "", p.description});
  }
  return text;
}

std::string ForeignTable() {
  std::string text = Head({"name", "of", "here", "remark"});
  for (const ForeignName& foreign : ForeignNames()) {
    std::string here;
    for (const std::string& name : foreign.here) here += (here.empty() ? "" : ", ") + Code(name);
    text +=
        Row({Code(foreign.name), foreign.packages, here.empty() ? "none" : here, foreign.remark});
  }
  return text;
}

}  // namespace

std::string WriteReference(const std::vector<ParameterSet>& sets) {
  std::string text =
      "# Parameters\n\n"
      "Written by `list_parameters --markdown` from the source that the nodes use. Names are "
      "private "
      "to the node, as in `/mapper/resolution`. Those marked live may be changed while the node "
      "runs, with rqt_reconfigure or `rosrun dynamic_reconfigure dynparam`: the change takes "
      "effect "
      "at the next scan, all values of a request or none, and neither map nor pose is lost.\n";
  for (const ParameterSet& set : sets) text += "\n## " + set.node() + "\n\n" + NodeTable(set);
  return text +
         "\n## Names of other packages\n\n"
         "A node that is given one of these says what to use instead, and goes on without it.\n\n" +
         ForeignTable();
}

}  // namespace scan_image_slam
