#include "bench/common/build_info.h"

#include <fstream>

#include <fmt/format.h>
#include <Eigen/Core>

#include <sixdof/base/library_build.h>
#ifdef SIXDOF_WITH_FCL
#include <sixdof/algorithm/fcl/fcl.h>
#endif

#include "sixdof_commit.h"

namespace sixdof {
namespace {

/// Model name of the first processor in /proc/cpuinfo; "unknown" where there is none.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

std::string program_version() { return fmt::format("{} {}", SIXDOF_VERSION, k_short_commit); }

std::vector<std::pair<std::string, std::string>> build_info() {
  return {
      {"sixdof_version", SIXDOF_VERSION},
      {"commit", k_commit},
      {"commit_dirty", k_commit_dirty ? "true" : "false"},
      {"compiler", SIXDOF_COMPILER},
      {"flags", SIXDOF_FLAGS},
      {"build_type", SIXDOF_BUILD_TYPE},
      {"sixdof_build", to_string(library_build())},
      {"cpu_model", processor()},
      {"version:eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"version:benchmark", SIXDOF_BENCHMARK_VERSION},
#ifdef SIXDOF_WITH_FCL
      {"fcl_build", fcl_build()},
#endif
  };
}

}  // namespace sixdof
