#include <sixdof/generation/overlap_bound.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sixdof {
namespace {

/// Upper bound on the area of a section of a box by a plane with the normal `n` (unit, in the box's frame).
double largest_section(const Eigen::Vector3d& size, const Eigen::Vector3d& n) {
  double area = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double projected = size[(i + 1) % 3] * size[(i + 2) % 3];
    if (n[i] != 0.0) area = std::min(area, projected / std::abs(n[i]));
  }
  return area;
}

}  // namespace

double overlap_upper_bound(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, const Eigen::Matrix3d& R_AB) {
  double bound = std::min(size_a.prod(), size_b.prod());
  for (Eigen::Index i = 0; i < 3; ++i) {
    bound = std::min(bound, size_b[i] * largest_section(size_a, R_AB.col(i)));
    bound = std::min(bound, size_a[i] * largest_section(size_b, R_AB.row(i).transpose()));
  }
  return bound;
}

}  // namespace sixdof
