#include "bench/common/hulls.h"

#include <sixdof/base/error.h>

#ifdef SIXDOF_WITH_CCD
#include <sixdof/algorithm/ccd/convex_hull.h>
#endif

namespace sixdof {

#ifdef SIXDOF_WITH_CCD
bool has_hulls() { return true; }

Mesh hull_of(const Mesh& mesh) { return convex_hull(mesh); }
#else
bool has_hulls() { return false; }

Mesh hull_of(const Mesh& /*mesh*/) {
  throw BadArgument("this build has no convex hulls: they need libqhull-dev and libccd-dev (SIXDOF_WITH_CCD)");
}
#endif

}  // namespace sixdof
