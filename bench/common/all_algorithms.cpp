#include "bench/common/all_algorithms.h"

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/query/registrar.h>
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

std::vector<std::string> register_all_algorithms(Registry& registry) {
  register_core_algorithms(registry);
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
  std::vector<std::string> external;
  for (const auto& make : Registrar::makers()) {
    registry.add(make());
    external.push_back(registry.all().back()->traits().name);
  }
  return external;
}

}  // namespace sixdof
