#pragma once

#include <string>

namespace sixdof::cli {

/// Version and commit of this build, e.g. "0.1.0 1a2b3c4d5e6f (modified)"; tells shards of two builds apart.
std::string program_version();

}  // namespace sixdof::cli
