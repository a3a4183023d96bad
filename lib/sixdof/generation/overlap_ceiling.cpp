#include <sixdof/generation/overlap_ceiling.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sixdof {
namespace {

/// Area of the largest section of a box across `n` (unit, in the box's frame), at most.
double largest_section(const Eigen::Vector3d& size, const Eigen::Vector3d& n) {
  double area = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double projected = size[(i + 1) % 3] * size[(i + 2) % 3];
    if (n[i] != 0.0) area = std::min(area, projected / std::abs(n[i]));
  }
  return area;
}

}  // namespace

double overlap_ceiling(const Eigen::Vector3d& size_a, const Eigen::Vector3d& size_b, const Eigen::Matrix3d& R_AB) {
  double ceiling = std::min(size_a.prod(), size_b.prod());
  for (Eigen::Index i = 0; i < 3; ++i) {
    ceiling = std::min(ceiling, size_b[i] * largest_section(size_a, R_AB.col(i)));
    ceiling = std::min(ceiling, size_a[i] * largest_section(size_b, R_AB.row(i).transpose()));
  }
  return ceiling;
}

}  // namespace sixdof
