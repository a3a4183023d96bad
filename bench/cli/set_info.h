#pragma once

#include <string>

namespace sixdof::cli {

/// Prints what a configuration set holds, as text or as JSON (lengths in the meshes' unit); reads no bucket.
/// @throws BadFile
void print_set_info(const std::string& file, bool as_json);

}  // namespace sixdof::cli
