#pragma once

#include "scan_image_slam/core/config/node_options.h"
#include "scan_image_slam/core/config/parameter_set.h"
#include "scan_image_slam/core/fusion/scan_image_fusion.h"
#include "scan_image_slam/core/mapping/loop_closer.h"
#include "scan_image_slam/core/mapping/mapper.h"
#include "scan_image_slam/core/matching/bounded_icp.h"

namespace scan_image_slam {

/// The parameters of each node, bound to the fields of its options. The sets point into the
/// options, which must outlive them.
ParameterSet FusionParameters(ScanImageFusionOptions* options, ScanImageFusionNodeOptions* node);
ParameterSet BoundedIcpParameters(BoundedIcpOptions* options, BoundedIcpNodeOptions* node);
ParameterSet MapperParameters(MapperOptions* options, LoopCloserOptions* loop,
                              MapperNodeOptions* node);

/// Options of the whole system.
struct SlamOptions {
  ScanImageFusionOptions fusion;
  ScanImageFusionNodeOptions fusion_node;
  BoundedIcpOptions bounded_icp;
  BoundedIcpNodeOptions bounded_icp_node;
  MapperOptions mapper;
  LoopCloserOptions loop_closer;
  MapperNodeOptions mapper_node;

  /// The sets of the three nodes, bound to this object.
  std::vector<ParameterSet> Parameters();
};

}  // namespace scan_image_slam
