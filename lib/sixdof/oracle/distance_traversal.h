#pragma once

#include <sixdof/oracle/distance_search.h>

/// The branch and bound of DistanceQuery. Internal: use distance.h.
namespace sixdof::detail {

/// Calls try_update() for one pair that is probably close: starts at the closest pair of seed corners and alternately
/// searches the corner of one mesh that is closest to that of the other. Does nothing if a pair closer than the seed
/// corners is known.
void seed_search(DistanceSearch& search, const SeedCorners& a, const SeedCorners& b);

/// Finds the closest pair of triangles whose distance is at most search.best. Of all pairs whose distance exceeds the
/// smallest by no more than ties.width, takes the one of smallest rank, whatever the order in which pairs were met and
/// whichever were known before. A distance of 0 ends the search, with any intersecting pair.
void find_closest(DistanceSearch& search);

/// Finds any intersecting pair of triangles: sets found and pair.
void find_intersection(DistanceSearch& search);

}  // namespace sixdof::detail
