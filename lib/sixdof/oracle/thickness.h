#pragma once

#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/pose.h>
#include <sixdof/geometry/tree.h>

namespace sixdof {

/// How thick the intersection of two solids is along a line: the length of that piece of the line p + t n within both
/// bodies that contains p. Where a corner of B is in A under a face whose normal is n, it is the depth of the corner.
///
/// Winding numbers along the line are counted from the triangles that it passes. Lines through edges and corners are
/// avoided: four lines beside it are taken, `beside` away, and the thickest counts, since the line may run along a face
/// of one of the bodies. In doubles; the error is some times `beside`.
class Thickness {
 public:
  /// The trees outlive it; each is that of a solid.
  Thickness(const Tree& a, const Tree& b) : a_(&a), b_(&b) {}

  /// @param p in A's frame
  /// @param n unit vector, in A's frame
  /// @param reach a piece of the line that comes so near to p contains it (length)
  /// @param beside see above (length), larger than the rounding of both meshes
  /// @return length; 0 if no piece contains p
  double at(const Pose& X_AB, const Eigen::Vector3d& p, const Eigen::Vector3d& n, double reach, double beside);

 private:
  struct Passage {
    double t;
    int of_a, of_b;  ///< 1: into the body, -1: out of it.
  };
  double along(const Pose& X_AB, const Eigen::Vector3d& p, const Eigen::Vector3d& n, double reach);

  const Tree* a_;
  const Tree* b_;
  std::vector<Passage> passages_;  // scratch
};

}  // namespace sixdof
