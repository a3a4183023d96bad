#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sixdof::bench {

/// What the figures depend on besides the algorithm, as (key, value) for the "context" of a result file: commit and
/// whether the tree differed from it, compiler, flags, build type, processor, versions of the libraries underneath.
std::vector<std::pair<std::string, std::string>> build_info();

}  // namespace sixdof::bench
