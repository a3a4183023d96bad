#include <sixdof/oracle/advancement.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

/// Rounding of the few operations of a bound, relative.
constexpr double k_bound_rounding = 1.0 + 1e-13;

/// Brackets are at least so many roundings of poses wide: below, yes/no may change its answer several times.
constexpr double k_rounding_width = 8.0;

/// Of a bracket's width, so that the difference of its rounded ends is not larger.
constexpr double k_inside = 1.0 - 1e-6;

Eigen::Vector3d corner_of(const Eigen::AlignedBox3d& box, int i) {
  return box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
}

/// Largest distance of the box's corners from B's origin.
double reach_of(const Motion& motion, const Eigen::AlignedBox3d& box) {
  double reach = 0.0;
  for (int i = 0; i < 8; ++i) reach = std::max(reach, (motion.start.R * corner_of(box, i)).norm());
  return std::max(reach, (motion.start.R * motion.reference).norm());
}

}  // namespace

double speed_bound(const Motion& motion, const Eigen::AlignedBox3d& box_b) {
  const double turn = motion.rotation.norm();
  if (turn == 0.0) return k_bound_rounding * motion.translation.norm();
  const Eigen::Vector3d axis = motion.rotation / turn;
  // The distance from the axis is convex, so a corner is the farthest.
  double arm = 0.0;
  for (int i = 0; i < 8; ++i) {
    arm = std::max(arm, axis.cross(motion.start.R * (corner_of(box_b, i) - motion.reference)).norm());
  }
  const double along = axis.dot(motion.translation), across = axis.cross(motion.translation).norm();
  return k_bound_rounding * std::hypot(along, across + turn * arm);
}

double bracket_width(const Motion& motion, const Eigen::AlignedBox3d& box_b) {
  const double speed = speed_bound(motion, box_b);
  if (speed == 0.0) return k_bracket_width;
  return std::max(k_bracket_width, k_rounding_width * motion.pose_error(reach_of(motion, box_b)) / speed);
}

ImpactBracket advance(DistanceQuery& query, const Eigen::AlignedBox3d& box_b, const Motion& motion,
                      const AdvancementOptions& options) {
  if (const char* const why = motion.why_invalid(); why != nullptr) throw BadArgument(why);
  using Kind = ImpactBracket::Kind;
  const double speed = options.speed_factor * speed_bound(motion, box_b);
  const double width = k_inside * bracket_width(motion, box_b);
  const double pose_error = motion.pose_error(reach_of(motion, box_b));
  ImpactBracket bracket{.t_free = options.from};
  const auto touches = [&](double t) {
    ++bracket.queries;
    return query.collide(motion.pose_at(t));
  };
  if (options.from == 0.0 && touches(0.0)) {
    bracket.kind = Kind::at_start;
    bracket.closest = query.distance(motion.start);
    return bracket;
  }
  for (std::uint64_t step = 0; step < options.most_steps; ++step) {
    bracket.closest = query.distance(motion.pose_at(bracket.t_free));
    ++bracket.queries;
    const double distance = bracket.closest.distance;
    const double free = distance * (1.0 - 4e-15) - 2.0 * pose_error;
    if (speed == 0.0 || bracket.t_free + free / speed >= 1.0) {
      bracket.t_free = bracket.t_touch = 1.0;
      return bracket;
    }
    if (free < width * speed) {
      bracket.t_touch = std::min(1.0, bracket.t_free + width);
      if (touches(bracket.t_touch)) {
        bracket.kind = Kind::hit;
        return bracket;
      }
    }
    const double next = bracket.t_free + free / speed;
    if (!(next > bracket.t_free)) break;  // closer than the rounding of poses
    bracket.t_free = next;
  }
  bracket.kind = Kind::grazing;
  bracket.t_touch = std::numeric_limits<double>::quiet_NaN();
  return bracket;
}

}  // namespace sixdof
