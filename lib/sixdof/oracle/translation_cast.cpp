#include <sixdof/oracle/translation_cast.h>

#include <algorithm>
#include <memory>

#include <sixdof/oracle/cast_search.h>

namespace sixdof {
namespace {

/// The search's target in roundings of the motion: what the ray cast takes for a tie is an eighth of it at most.
constexpr double k_roundings = 8.0;
/// The largest target, in units of the meshes' size.
constexpr double k_largest_target = 1e-8;
/// Deviations from a rotation above this are not small against the target.
constexpr double k_rotation_error = 4e-15;

/// Of a tree that somebody else keeps.
std::shared_ptr<const Tree> borrowed(const Tree& tree) { return {std::shared_ptr<const Tree>(), &tree}; }

bool is_rotation(const Eigen::Matrix3d& R) {
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() <= k_rotation_error;
}

}  // namespace

TranslationCast::TranslationCast(const Tree& a, const Tree& b)
    : a_(borrowed(a)),
      b_(&a == &b ? std::nullopt : std::optional(ray_cast::CastMesh(borrowed(b)))),
      search_(a_, b_ ? *b_ : a_) {}

std::optional<TranslationCast::Apart> TranslationCast::find(const Motion& motion) {
  const double length = motion.translation.norm();
  if (!motion.is_translation() || !(length > 0.0) || !is_rotation(motion.start.R)) return {};
  const Tree& a = search_.cast().a.tree();
  const Tree& b = search_.cast().b.tree();
  const double size = a.radius() + b.radius();
  const double target = k_roundings * cast_margin(motion, a, b);
  if (!(target <= k_largest_target * size)) return {};
  // Of B's centre from A's: start u + offset at first, last u + offset at the end.
  const Eigen::Vector3d u = motion.translation / -length;
  const Eigen::Vector3d centers = motion.start * b.center() - a.center();
  const double start = centers.dot(u), last = start - length;
  const Eigen::Vector3d offset = centers - start * u;
  if (offset.norm() >= size + target || last >= size + target) return Apart{};
  search_.set_rotation(motion.start.R);
  search_.start_ray(u, offset, std::max(last, -(size + target)));
  const ray_cast::Hit* const hit = search_.find_next(target);
  if (hit == nullptr) return Apart{};
  const double t = (start - hit->translation) / length;
  if (!(t > 0.0)) return {};
  if (t >= 1.0) return Apart{};
  return Apart{t, hit->pair};
}

std::size_t TranslationCast::bytes() const {
  return sizeof(*this) + a_.precise_volumes().size_bytes() + (b_ ? b_->precise_volumes().size_bytes() : 0);
}

}  // namespace sixdof
