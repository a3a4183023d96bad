#include "bench/common/pair_warnings.h"

#include <fmt/format.h>

#include "bench/common/run_guarded.h"

namespace sixdof {

void warn_of_sizes(std::string_view program, const MeshIdentity& a, const MeshIdentity& b) {
  const bool a_is_larger = a.diagonal() >= b.diagonal();
  const MeshIdentity& large = a_is_larger ? a : b;
  const MeshIdentity& small = a_is_larger ? b : a;
  const double ratio = large.diagonal() / small.diagonal();
  if (!(ratio >= k_suspicious_size_ratio)) return;
  print_message(program,
                fmt::format("warning: {} is {:.0f} times as large as {} (box diagonals {:.4g} and {:.4g}); are "
                            "both in the same unit?",
                            large.name, ratio, small.name, large.diagonal(), small.diagonal()));
}

void say_notes(std::string_view program, const Mesh& mesh, std::string_view argument) {
  for (const std::string& note : mesh.repairs().notes) print_message(program, fmt::format("{}: {}", argument, note));
}

void warn_of_unreached(std::string_view program, const ConfigurationSet& set) {
  for (const BucketSummary& bucket : set.buckets()) {
    if (bucket.reachable > 0) continue;
    print_message(program, fmt::format("warning: {}: no configuration reaches {} {} %", set.path().string(),
                                       to_string(bucket.key.kind), bucket.key.percent));
  }
}

}  // namespace sixdof
