#include "bench/common/scene_algorithms.h"

#ifdef SIXDOF_WITH_BULLET
#include <sixdof/scene/bullet/bullet_deform.h>
#include <sixdof/scene/bullet/bullet_scene.h>
#endif
#ifdef SIXDOF_WITH_EMBREE
#include <sixdof/scene/embree/embree_deform.h>
#endif
#ifdef SIXDOF_WITH_FCL
#include <sixdof/scene/fcl/fcl_deform.h>
#include <sixdof/scene/fcl/fcl_scene.h>
#endif
#ifdef SIXDOF_WITH_ODE
#include <sixdof/scene/ode/ode_deform.h>
#include <sixdof/scene/ode/ode_scene.h>
#endif

namespace sixdof {

scene::SceneAlgorithms all_scene_algorithms() {
  scene::SceneAlgorithms algorithms;
  scene::add_own_algorithms(algorithms);
#ifdef SIXDOF_WITH_FCL
  scene::add_fcl_scenes(algorithms);
  scene::add_fcl_deforms(algorithms);
#endif
#ifdef SIXDOF_WITH_BULLET
  scene::add_bullet_scenes(algorithms);
  scene::add_bullet_deforms(algorithms);
#endif
#ifdef SIXDOF_WITH_ODE
  scene::add_ode_scenes(algorithms);
  scene::add_ode_deforms(algorithms);
#endif
#ifdef SIXDOF_WITH_EMBREE
  scene::add_embree_deforms(algorithms);
#endif
  return algorithms;
}

}  // namespace sixdof
