#include <sixdof/geometry/typed_pose.h>

#include <fmt/format.h>

namespace sixdof {

TypedPose TypedPose::of(const Pose& X_AB) {
  const Eigen::Vector4d q = X_AB.quaternion().normalized();
  return {q, Pose::from_quaternion(q[0], q[1], q[2], q[3], X_AB.t)};
}

std::string TypedPose::text() const {
  const Eigen::Vector4d& q = quaternion;
  const Eigen::Vector3d& t = X_AB.t;
  return fmt::format("{} {} {} {} {} {} {}", t[0], t[1], t[2], q[0], q[1], q[2], q[3]);
}

}  // namespace sixdof
