#pragma once

#include <coal/collision.h>
#include <fcl/narrowphase/distance.h>

namespace coal {

struct DistanceRequest : QueryRequest {
  bool enable_signed_distance = true;
};

struct DistanceResult : QueryResult {
  double min_distance = std::numeric_limits<double>::max();
  std::array<Vec3s, 2> nearest_points = {Vec3s::Zero(), Vec3s::Zero()};
};

inline double distance(const CollisionGeometry* a, const Transform3s& X_a, const CollisionGeometry* b,
                       const Transform3s& X_b, const DistanceRequest& /*request*/, DistanceResult& result) {
  fcl::DistanceResultd found;
  fcl::distance<double>(&a->model, X_a.fcl(), &b->model, X_b.fcl(), fcl::DistanceRequestd(true), found);
  result.min_distance = found.min_distance;
  result.nearest_points = {found.nearest_points[0], found.nearest_points[1]};
  return result.min_distance;
}

class ComputeDistance {
 public:
  ComputeDistance(const CollisionGeometry* a, const CollisionGeometry* b) : a_(a), b_(b) {}
  double operator()(const Transform3s& X_a, const Transform3s& X_b, const DistanceRequest& request,
                    DistanceResult& result) const {
    return distance(a_, X_a, b_, X_b, request, result);
  }

 private:
  const CollisionGeometry *a_, *b_;
};

}  // namespace coal
