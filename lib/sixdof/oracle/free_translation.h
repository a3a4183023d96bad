#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/oracle/cast_search.h>
#include <sixdof/oracle/distance.h>

/// Translations of B after which the bodies have no common point. Internal: outside of the library use penetration.h.
namespace sixdof::detail {

/// The bodies are disjoint wherever the normal's component of the translation is at least `offset`, as far as one
/// contact tells.
struct ContactPlane {
  Eigen::Vector3d normal;  ///< Unit vector, from A to B.
  double offset;           ///< A length.
};

/// The shortest vector with normal . x >= offset for all planes, of which there are few; none if there is no such
/// vector up to rounding. Tries all sets of up to three planes.
std::optional<Eigen::Vector3d> shortest_beyond(std::span<const ContactPlane> planes);

/// Searches for short free translations of B, by exact yes/no and by exact first contacts. One object per thread.
/// Answers depend on the arguments alone.
class FreeTranslations {
 public:
  /// The oracle outlives it.
  explicit FreeTranslations(const DistanceOracle& oracle);

  /// The pose after a translation d (A's frame).
  static Pose moved(const Pose& X_AB, const Eigen::Vector3d& d) { return {X_AB.R, X_AB.t + d}; }

  /// Whether the bodies have no point in common after a translation of B by d. Exact.
  bool is_free(const Pose& X_AB, const Eigen::Vector3d& d) { return !query_.collide(moved(X_AB, d), false); }

  /// A common point of the surfaces after that translation; none if there is none.
  std::optional<Eigen::Vector3d> crossing(const Pose& X_AB, const Eigen::Vector3d& d);

  /// Where a straight motion ends.
  struct Stop {
    Eigen::Vector3d d = Eigen::Vector3d::Zero();  ///< Free, and as close to the contact as a cast comes.
    bool blocked = false;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< At the contact, from A to B; zero if not known.
  };
  /// From a free translation straight towards another, up to the first contact.
  Stop move(const Pose& X_AB, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

  /// From far away in this direction straight towards no translation. @param direction unit vector in A's frame
  Stop approach(const Pose& X_AB, const Eigen::Vector3d& direction);

  /// Slides from a free translation to shorter ones along the planes of contacts, until none of the contacts allows a
  /// shorter one: in this way penetration depths are estimated in C. Je, M. Tang, Y. Lee, M. Lee and Y. J. Kim,
  /// "PolyDepth: Real-time Penetration Depth Computation Using Iterative Contact-Space Projection", 2012.
  /// @return a free translation, not longer than d
  Eigen::Vector3d descend(const Pose& X_AB, const Eigen::Vector3d& d);

  /// First contacts searched so far.
  std::uint64_t casts() const { return casts_; }

 private:
  Eigen::Vector3d slide(const Pose& X_AB, const Eigen::Vector3d& d, double margin);

  const DistanceOracle& oracle_;
  DistanceQuery query_;
  CastSearch cast_;
  std::uint64_t casts_ = 0;
};

}  // namespace sixdof::detail
