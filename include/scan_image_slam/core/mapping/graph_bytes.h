#pragma once

#include "scan_image_slam/core/mapping/byte_stream.h"
#include "scan_image_slam/core/mapping/map_state.h"

namespace scan_image_slam {

/// The part of a state file that holds the graph.
void Put(const GraphMemory& graph, ByteWriter* out);

/// Throws std::runtime_error that names the byte if something refers to nothing.
GraphMemory GetGraph(ByteReader* in);

void Put(const AttachedPose& pose, ByteWriter* out);

/// Hangs on a keyframe of the graph, maybe one that was let go, or on the map; throws else.
AttachedPose GetAttached(ByteReader* in, const GraphMemory& graph);

}  // namespace scan_image_slam
