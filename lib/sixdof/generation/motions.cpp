#include <sixdof/generation/motions.h>

#include <random>

namespace sixdof {
namespace {

/// Numbers with the same bits on every machine, which distributions of <random> do not promise.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : generator_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(generator_() >> 11) * 0x1p-53);
  }

  /// Uniform over the sphere, by rejection.
  Eigen::Vector3d unit_vector() {
    while (true) {
      const double x = between(-1.0, 1.0), y = between(-1.0, 1.0), z = between(-1.0, 1.0);
      const Eigen::Vector3d p(x, y, z);
      const double norm = p.norm();
      if (norm > 0.1 && norm < 1.0) return p / norm;
    }
  }

  /// Unit vector across another one.
  Eigen::Vector3d across(const Eigen::Vector3d& u) {
    while (true) {
      const Eigen::Vector3d p = unit_vector(), rest = p - u * u.dot(p);
      if (rest.norm() > 0.1) return rest.normalized();
    }
  }

 private:
  std::mt19937_64 generator_;
};

/// Every so many motions one passes A.
constexpr std::size_t k_passing = 4;

}  // namespace

std::vector<Motion> motions_of(std::span<const Pose> contacts, const Mesh& a, const Mesh& b, MotionKind kind,
                               double percent, std::uint64_t seed) {
  const double length = 0.01 * percent * a.diagonal();
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    Draw draw(seed + i);
    const Eigen::Vector3d line = contacts[i] * b.center() - a.center();
    const Eigen::Vector3d outwards = line.norm() > 0.0 ? Eigen::Vector3d(line.normalized()) : draw.unit_vector();
    Motion motion = Motion::of(b, contacts[i], Eigen::Vector3d::Zero());
    if (kind != MotionKind::rotation) {
      const bool passes = i % k_passing == k_passing - 1;
      const Eigen::Vector3d course = passes ? draw.across(outwards) : Eigen::Vector3d(-outwards);
      motion.start.t -= draw.between(0.25, 0.75) * length * course;
      if (passes) motion.start.t += draw.between(0.0, 0.25) * length * outwards;
      motion.translation = length * course;
    } else {
      motion.start.t += draw.between(0.0, 0.25) * length * outwards;
    }
    if (kind != MotionKind::translation) motion.rotation = length / (0.5 * b.diagonal()) * draw.unit_vector();
    motions.push_back(motion);
  }
  return motions;
}

}  // namespace sixdof
