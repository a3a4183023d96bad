#include "bench/common/all_algorithms.h"

#include <sixdof/algorithm/core_algorithms.h>
#ifdef SIXDOF_WITH_BULLET
#include <sixdof/algorithm/bullet/bullet.h>
#endif
#ifdef SIXDOF_WITH_FCL
#include <sixdof/algorithm/fcl/fcl.h>
#endif
#ifdef SIXDOF_WITH_ODE
#include <sixdof/algorithm/ode/ode.h>
#endif

namespace sixdof {

void register_all_algorithms(Registry& registry) {
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
}

}  // namespace sixdof
