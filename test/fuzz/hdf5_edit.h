#pragma once

#include <filesystem>

#include "fuzz.h"

namespace sixdof::fuzz {

/// Damages an HDF5 file as the input says: its bytes, or, with right checksums, what it holds: attributes and datasets
/// of other values, types and sizes, and objects that are missing.
void damage_hdf5(const std::filesystem::path& file, Input& input);

}  // namespace sixdof::fuzz
