#include <sixdof/algorithm/ist/node_pair.h>

namespace sixdof::ist {

NodePlacement NodePlacement::of(const SphereTree& a, const SphereTree& b, const Pose& X_AB) {
  // Rounding of a pose's rotation and of this very sum, many times over.
  constexpr double k_meet = 1.0 + 1e-12;
  // In overlap all lengths are below T = 2 (1 + ratio). With u = 2^-24 a coordinate of a moved centre (three products
  // of rounded factors, the rounded shift, three sums) is off by less than 13 u T and its place by sqrt(3) times that;
  // the differences, squares and sums of the test add less than 9 u T.
  constexpr float k_slack = 32.0f / (1 << 24);
  NodePlacement placement;
  const double unit = a.bound.radius, ratio = b.bound.radius / unit;
  const Eigen::Vector3d shift = (X_AB * b.bound.center - a.bound.center) / unit;
  placement.apart = !(shift.norm() <= k_meet * (1.0 + ratio));
  if (placement.apart) return placement;
  placement.turn = (ratio * X_AB.R).cast<float>();
  placement.shift = shift.cast<float>();
  placement.ratio = static_cast<float>(ratio);
  placement.slack = k_slack * 2.0f * (1.0f + placement.ratio);
  return placement;
}

}  // namespace sixdof::ist
