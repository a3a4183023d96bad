#include "bench/common/hulls.h"

#include <sixdof/base/error.h>

#ifdef SIXDOF_WITH_CCD
#include <sixdof/algorithm/ccd/convex_hull.h>
#endif

namespace sixdof {

#ifdef SIXDOF_WITH_CCD
Mesh hull_of(const Mesh& mesh) { return convex_hull(mesh); }
#else
Mesh hull_of(const Mesh& /*mesh*/) {
  throw BadArgument("this build has no convex hulls: they need libqhull-dev and libccd-dev (SIXDOF_WITH_CCD)");
}
#endif

}  // namespace sixdof
