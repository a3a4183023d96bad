#pragma once

#include <string>

namespace sixdof::cli {

/// Prints a mesh's counts, topology, measures, hash and repairs. Lengths are in the mesh's own unit and frame; numbers
/// in JSON have up to 17 significant digits. @throws BadFile, BadArgument (load_model)
void print_mesh_info(const std::string& name_or_file, bool json);

}  // namespace sixdof::cli
