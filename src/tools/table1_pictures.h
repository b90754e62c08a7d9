#pragma once

#include "table1_run.h"

#include <string>

namespace scan_image_slam {

/// The paper's Fig. 6 of one run: the true way, that of the first proposed configuration and that
/// of CoreSLAM, each drawn into the true map. Throws std::runtime_error if the file can't be
/// written.
void WriteFigure6(const std::string& path, const Scenario& scenario, const Table1Result& result);

}  // namespace scan_image_slam
