#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sixdof {

/// Version and commit of this build, e.g. "0.1.0 1a2b3c4d5e6f (modified)"; tells shards of two builds apart.
std::string program_version();

/// What times depend on besides the algorithm, as (key, value) for the "context" of a result file: commit and whether
/// the tree differed from it, compiler, flags, build type, processor, versions of libraries.
std::vector<std::pair<std::string, std::string>> build_info();

}  // namespace sixdof
