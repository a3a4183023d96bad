#include <sixdof/algorithm/ist/node_pair.h>

namespace sixdof::ist {

NodeTransform NodeTransform::of(const SphereTree& a, const SphereTree& b, const Pose& X_AB) {
  // Far above the rounding of the pose's rotation and of the sums below.
  constexpr double k_touch = 1.0 + 1e-12;
  // In overlap all lengths are below T = 2 (1 + ratio). With u = 2^-24 a coordinate of a transformed centre (three
  // products of rounded factors, the rounded translation, three sums) is off by less than 13 u T and the centre by
  // sqrt(3) times that; the differences, squares and sums of the test add less than 9 u T.
  constexpr float k_slack = 32.0f / (1 << 24);
  NodeTransform result;
  const double unit = a.bound.radius, ratio = b.bound.radius / unit;
  const Eigen::Vector3d translation = (X_AB * b.bound.center - a.bound.center) / unit;
  result.apart = !(translation.norm() <= k_touch * (1.0 + ratio));
  if (result.apart) return result;
  result.rotation = (ratio * X_AB.R).cast<float>();
  result.translation = translation.cast<float>();
  result.ratio = static_cast<float>(ratio);
  result.slack = k_slack * 2.0f * (1.0f + result.ratio);
  return result;
}

}  // namespace sixdof::ist
