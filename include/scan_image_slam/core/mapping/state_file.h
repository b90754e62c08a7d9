#pragma once

#include "scan_image_slam/core/mapping/map_state.h"

#include <string>

namespace scan_image_slam {

/// A state as bytes: numbers with the low byte first.
///
///   8 bytes "SISTATE\n", u32 version, u32 CRC-32 and u64 size of what follows
///   the graph, drawn scans, the chain
///
/// The field-by-field order is that of the structs in map_state.h, lists as a u32 count and the
/// things. A field more or less is a new version.
std::string EncodeState(const MapState& state);

/// The state that was encoded, bit for bit. Throws std::runtime_error that says what is wrong at
/// which byte: another kind of file, a newer version, an end too early, damage. Nothing larger than
/// a fixed multiple of the bytes is allocated.
MapState DecodeState(const std::string& bytes);

/// Writes a state so that the file is the old or the new one, whatever happens in between: into a
/// file beside it, which then takes its place. Throws std::runtime_error that names the file.
void WriteState(const MapState& state, const std::string& path);

/// Throws std::runtime_error that names the file and, as DecodeState, what is wrong with it.
MapState ReadState(const std::string& path);

}  // namespace scan_image_slam
