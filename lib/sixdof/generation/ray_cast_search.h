#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <sixdof/generation/ray_cast_traversal.h>
#include <sixdof/generation/ray_cast_tree.h>
#include <sixdof/geometry/triangle_pair.h>

namespace sixdof::ray_cast {

/// Finds the first hits of rays for descending targets. Each search starts from the hits of the target before it and of
/// the ray before it. Notation: see ray_cast_traversal.h. Internal: use ray_cast.h.
class RaySearch {
 public:
  /// Both trees outlive the search.
  RaySearch(const CastTree& tree_a, const CastTree& tree_b) : cast_(tree_a, tree_b) {}

  /// After a tree was transformed: forgets everything.
  void clear();

  /// @param direction unit vector
  /// @param targets number of targets that follow
  void start_ray(const Eigen::Vector3d& direction, std::size_t targets);

  /// Finds the first hit for the ray's next target.
  /// @param target positive, and not larger than the one before
  /// @return null if there is none at a translation of 0 or more, up to a tie; otherwise valid until the next call
  const Hit* find_next(double target);

  const Cast& cast() const { return cast_; }

 private:
  /// The hit for the target before.
  struct LastTarget {
    double target;
    Hit hit;
  };

  void search_from(double translation, const Eigen::Vector3d& axis);
  bool find_behind(const LastTarget& last);

  Cast cast_;
  std::size_t next_ = 0;  // target of this ray
  bool reachable_ = true;
  std::optional<LastTarget> last_;
  std::vector<std::optional<TrianglePair>> last_ray_;  // pair of each target
};

}  // namespace sixdof::ray_cast
