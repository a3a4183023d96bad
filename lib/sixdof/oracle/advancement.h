#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include <sixdof/geometry/motion.h>
#include <sixdof/oracle/distance.h>

/// When two bodies first touch while one moves, by conservative advancement on the exact distance (Mirtich 1996): the
/// truth for time of impact. It shares no bound with the search of cast_search.h, which it checks.
///
/// Where the distance is d at t and no point of B moves faster than mu, the bodies stay apart for d / mu. The bound mu
/// takes the motion along the axis of rotation and across it apart, and the largest distance of B's box from the axis:
/// both are the same at all times. Corners of the box are moved by the start's own matrix, so a stretch counts.
/// Distances are lowered by the rounding of poses (Motion::pose_error()) twice: what is free here is free at the poses
/// that Motion::pose_at() computes, too.

namespace sixdof {

/// What is proven about a motion.
struct ImpactBracket {
  /// How a search ended.
  enum class Kind {
    none,      ///< The bodies never touch.
    hit,       ///< They touch at t_touch, and not up to t_free.
    at_start,  ///< They touch at t = 0.
    grazing    ///< They do not touch up to t_free. From there on it is not decided: they are too close for too long.
  };
  Kind kind = Kind::none;
  double t_free = 0.0;   ///< The bodies are apart from 0 to here; 1 if they never touch, 0 in contact at the start.
  double t_touch = 0.0;  ///< Of a hit: exact yes/no says yes; t_touch - t_free is at most bracket_width().
  Separation closest;    ///< At t_free.
  std::uint64_t queries = 0;  ///< Distances and yes/no that were asked.
};

/// Width of a bracket, in units of the motion, unless roundings of the poses are larger.
inline constexpr double k_bracket_width = 1e-9;

/// No point of a box moves faster than this (length per unit of t) at any time of the motion.
double speed_bound(const Motion& motion, const Eigen::AlignedBox3d& box_b);

/// Largest width of a bracket: k_bracket_width, or eight times the time in which B moves by the rounding of its poses.
double bracket_width(const Motion& motion, const Eigen::AlignedBox3d& box_b);

/// How an advancement begins and when it gives up.
struct AdvancementOptions {
  double from = 0.0;                 ///< The bodies are known to be apart from 0 to here.
  std::uint64_t most_steps = 20000;  ///< Distances after which a motion is grazing.
  double speed_factor = 1.0;         ///< For tests: below 1 the bound is unsafe.
};

/// @param query its oracle's B is the mesh with this box
/// @throws BadArgument if the motion cannot be computed (Motion::why_invalid())
ImpactBracket advance(DistanceQuery& query, const Eigen::AlignedBox3d& box_b, const Motion& motion,
                      const AdvancementOptions& options = {});

}  // namespace sixdof
