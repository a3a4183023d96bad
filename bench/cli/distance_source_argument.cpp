#include <sixdof/bench/cli/distance_source_argument.h>

#include <sixdof/algorithm/algorithm_source.h>
#include <sixdof/configuration/brute_force_source.h>

namespace sixdof::cli {

std::shared_ptr<const DistanceSource> distance_source_argument(const Registry& registry, const std::string& name) {
  if (auto oracle = make_brute_force_source(); oracle->name() == name) return oracle;
  return make_distance_source(registry.find(name));
}

}  // namespace sixdof::cli
