#include <sixdof/algorithm/core_algorithms.h>

#include <sixdof/algorithm/brute_force.h>
#include <sixdof/algorithm/exact.h>
#include <sixdof/algorithm/ist/ist.h>
#include <sixdof/algorithm/null.h>
#include <sixdof/algorithm/vps/vps.h>

namespace sixdof {

void register_core_algorithms(Registry& registry) {
  registry.add(make_null_algorithm());
  registry.add(make_brute_force_algorithm());
  registry.add(make_exact_algorithm());
  registry.add(make_ist_algorithm());
  registry.add(make_vps_algorithm());
  registry.add(make_vps_field_algorithm());
}

}  // namespace sixdof
