#include "bench/common/all_algorithms.h"

#include <set>
#include <utility>

#include <fmt/format.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/process/remote_algorithm.h>
#include <sixdof/query/registrar.h>
#include "bench/common/rivals.h"
#include "bench/common/run_guarded.h"
#include "bench/common/serve_algorithm.h"
#ifdef SIXDOF_WITH_BULLET
#include <sixdof/algorithm/bullet/bullet.h>
#endif
#ifdef SIXDOF_WITH_CCD
#include <sixdof/algorithm/ccd/ccd.h>
#endif
#ifdef SIXDOF_WITH_CGAL
#include <sixdof/algorithm/cgal/cgal.h>
#endif
#ifdef SIXDOF_WITH_COAL
#include <sixdof/algorithm/coal/coal.h>
#endif
#ifdef SIXDOF_WITH_EMBREE
#include <sixdof/algorithm/embree/embree.h>
#endif
#ifdef SIXDOF_WITH_FCL
#include <sixdof/algorithm/fcl/fcl.h>
#endif
#ifdef SIXDOF_WITH_GTS
#include <sixdof/algorithm/gts/gts.h>
#endif
#ifdef SIXDOF_WITH_MUJOCO
#include <sixdof/algorithm/mujoco/mujoco.h>
#endif
#ifdef SIXDOF_WITH_ODE
#include <sixdof/algorithm/ode/ode.h>
#endif
#ifdef SIXDOF_WITH_SIMBODY
#include <sixdof/algorithm/simbody/simbody.h>
#endif

namespace sixdof {

namespace {

/// Those of the backends that were built.
void register_backends(Registry& registry) {
#ifdef SIXDOF_WITH_FCL
  register_fcl_algorithms(registry);
#endif
#ifdef SIXDOF_WITH_BULLET
  register_bullet_algorithms(registry);
#endif
#ifdef SIXDOF_WITH_ODE
  register_ode_algorithms(registry);
#endif
#ifdef SIXDOF_WITH_EMBREE
  register_embree_algorithms(registry);
#endif
#ifdef SIXDOF_WITH_GTS
  register_gts_algorithms(registry);
#endif
#ifdef SIXDOF_WITH_SIMBODY
  register_simbody_algorithms(registry);
#endif
#ifdef SIXDOF_WITH_CCD
  register_ccd_algorithms(registry);
#endif
#ifdef SIXDOF_WITH_MUJOCO
  register_mujoco_algorithms(registry);
#endif
#ifdef SIXDOF_WITH_COAL
  register_coal_algorithms(registry);
#endif
#ifdef SIXDOF_WITH_CGAL
  register_cgal_algorithms(registry);
#endif
}

}  // namespace

std::vector<std::string> register_all_algorithms(Registry& registry, const ProcessOptions& options,
                                                 std::string_view program) {
  Registry local;
  register_core_algorithms(local);
  const std::size_t own = local.all().size();
  register_backends(local);
  std::vector<std::string> added;
  for (const auto& make : Registrar::makers()) {
    local.add(make());
    added.push_back(local.all().back()->traits().name);
  }
  const ProcessLimits limits = options.limits();
  std::size_t place = 0;
  for (std::unique_ptr<Algorithm>& algorithm : local.take()) {
    const bool third_party = place++ >= own;
    if (options.isolate == "all" || (options.isolate == "third-party" && third_party)) {
      RemoteProgram server = remote_program(serving_command(algorithm->traits().name), limits);
      algorithm = std::make_unique<RemoteAlgorithm>(std::move(algorithm), std::move(server));
    }
    registry.add(std::move(algorithm));
  }
  std::vector<std::pair<std::string, std::string>> external;
  std::set<std::string> replaced;
  for (const std::string& text : options.external) {
    external.push_back(parse_external(text));
    replaced.insert(external.back().first);
  }
  if (options.rivals) {
    for (const std::string& warning : register_rivals(registry, rivals_folder(), limits, replaced)) {
      print_message(program, fmt::format("warning: rival left out: {}", warning));
    }
  }
  for (const auto& [name, command] : external) {
    registry.add(RemoteAlgorithm::external(name, command, limits));
    added.push_back(name);
  }
  return added;
}

}  // namespace sixdof
