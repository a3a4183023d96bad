#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/algorithm/ist/free_space.h>

namespace sixdof::ist {

/// Where the search for a centre starts, in the free space.
struct Start {
  Eigen::Vector3d position;
  double bound;                ///< Upper bound on the clearance here.
  double min_clearance = 0.0;  ///< With less clearance than this the start is discarded.
};

/// A candidate for a sphere's centre: a local maximum of the clearance.
struct Prototype {
  Eigen::Vector3d position;
  double clearance = 0.0;   ///< 0 if the start was discarded.
  std::uint64_t order = 0;  ///< Breaks ties.
  bool operator<(const Prototype& o) const {
    return clearance != o.clearance ? clearance < o.clearance : order > o.order;
  }
};

/// The prototype of every start, in parallel. Their order counts from `first` on. The same bits for every number of
/// threads.
///
/// First phase: away from the closest obstacle while that doubles the clearance. Second phase, by cutting planes: every
/// measured clearance adds an obstacle to a model, whose maximum within a trust region is measured next.
std::vector<Prototype> find_prototypes(const FreeSpace& space, std::span<const Start> starts, std::uint64_t first);

}  // namespace sixdof::ist
