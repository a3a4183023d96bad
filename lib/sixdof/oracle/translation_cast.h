#pragma once

#include <cstddef>
#include <optional>

#include <sixdof/geometry/motion.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/ray_cast_search.h>

namespace sixdof {

/// First contacts of translations by the ray cast (ray_cast_search.h), for B that comes from outside: nothing touches
/// on the line of its motion from far away up to the start. One object per thread.
class TranslationCast {
 public:
  /// Both trees outlive it.
  TranslationCast(const Tree& a, const Tree& b);
  TranslationCast(const TranslationCast&) = delete;
  TranslationCast& operator=(const TranslationCast&) = delete;

  /// Up to when the surfaces are apart.
  struct Apart {
    double t = 1.0;  ///< 1 without a pair.
    std::optional<TrianglePair>
        next;  ///< Numbers in the trees' corners(): some roundings apart then, and coming nearer.
  };

  /// @return none if the motion rotates B, or starts at or behind the first contact on its line, or if coordinates are
  /// so large that their rounding is no small part of the meshes
  std::optional<Apart> find(const Motion& motion);

  std::size_t bytes() const;

 private:
  ray_cast::CastMesh a_;
  std::optional<ray_cast::CastMesh> b_;  ///< None if both trees are the same object.
  ray_cast::RaySearch search_;
};

}  // namespace sixdof
