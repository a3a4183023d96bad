#include <sixdof/oracle/overlap.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <sixdof/base/compensated_sum.h>
#include <sixdof/base/error.h>

namespace sixdof {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A convex polygon in the xy plane, counter-clockwise. It is a triangle clipped by up to four half-planes: at most
/// seven corners.
struct Polygon {
  std::array<Vector2d, 8> corner;
  std::size_t size = 0;
  void push(const Vector2d& p) { corner[size++] = p; }
};

double cross(const Vector2d& u, const Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

/// The part of a polygon where a linear function is not negative.
template <class Linear>
Polygon clip(const Polygon& polygon, const Linear& value) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vector2d& p = polygon.corner[i];
    const Vector2d& q = polygon.corner[(i + 1) % polygon.size];
    const double at_p = value(p);
    const double at_q = value(q);
    if (at_p >= 0.0) kept.push(p);
    if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0)) kept.push(p + (at_p / (at_p - at_q)) * (q - p));
  }
  return kept;
}

/// A face as a function over its projection: z = offset + slope . (xy - anchor).
struct Face {
  std::array<Vector2d, 3> corner;  // counter-clockwise
  Vector2d low, high;              // box of the projection
  Vector2d slope, anchor;
  double offset = 0.0, sign = 0.0;

  double z(const Vector2d& p) const { return offset + slope.dot(p - anchor); }
};

std::vector<Face> project(const Mesh& mesh, const Pose& pose, const Vector3d& origin) {
  std::vector<Face> faces;
  for (const Triangle& t : mesh.triangles()) {
    std::array<Vector3d, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = pose * mesh.vertices()[t[k]] - origin;
    const Vector3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    if (n.z() == 0.0) continue;  // parallel to z: its projection has no area
    Face f;
    f.sign = n.z() > 0.0 ? 1.0 : -1.0;
    if (n.z() < 0.0) std::swap(c[1], c[2]);
    for (std::size_t k = 0; k < 3; ++k) f.corner[k] = c[k].head<2>();
    f.low = f.corner[0].cwiseMin(f.corner[1]).cwiseMin(f.corner[2]);
    f.high = f.corner[0].cwiseMax(f.corner[1]).cwiseMax(f.corner[2]);
    f.anchor = f.corner[0];
    f.offset = c[0].z();
    f.slope = Vector2d(-n.x() / n.z(), -n.y() / n.z());
    faces.push_back(f);
  }
  return faces;
}

/// Integral of a linear function over a polygon: area times the mean of the corners, over each triangle of a fan.
template <class Linear>
double integrate(const Polygon& polygon, const Linear& value) {
  double sum = 0.0;
  for (std::size_t i = 2; i < polygon.size; ++i) {
    const Vector2d &p = polygon.corner[0], &q = polygon.corner[i - 1], &r = polygon.corner[i];
    sum += cross(q - p, r - p) / 6.0 * (value(p) + value(q) + value(r));
  }
  return sum;
}

/// Integral of min(z_f, z_g) over the intersection of the projections.
double integrate_lower(const Face& f, const Face& g) {
  Polygon common;
  for (const Vector2d& p : f.corner) common.push(p);
  for (std::size_t k = 0; k < 3 && common.size > 2; ++k) {
    const Vector2d& p = g.corner[k];
    const Vector2d side = g.corner[(k + 1) % 3] - p;
    common = clip(common, [&](const Vector2d& x) { return cross(side, x - p); });
  }
  if (common.size < 3) return 0.0;
  const auto f_lower = clip(common, [&](const Vector2d& x) { return g.z(x) - f.z(x); });
  const auto g_lower = clip(common, [&](const Vector2d& x) { return f.z(x) - g.z(x); });
  // If z_f = z_g everywhere, both parts are the whole: it counts once.
  if (f_lower.size == common.size && g_lower.size == common.size) {
    bool equal = true;
    for (std::size_t i = 0; i < common.size; ++i) equal = equal && f.z(common.corner[i]) == g.z(common.corner[i]);
    if (equal) return integrate(common, [&](const Vector2d& x) { return f.z(x); });
  }
  return integrate(f_lower, [&](const Vector2d& x) { return f.z(x); }) +
         integrate(g_lower, [&](const Vector2d& x) { return g.z(x); });
}

/// A uniform grid over the projections: each cell lists the faces whose projections' boxes overlap it.
class FaceGrid {
 public:
  explicit FaceGrid(const std::vector<Face>& faces) {
    if (faces.empty()) return;
    low_ = faces.front().low;
    high_ = faces.front().high;
    for (const Face& f : faces) {
      low_ = low_.cwiseMin(f.low);
      high_ = high_.cwiseMax(f.high);
    }
    // About as many square cells as faces.
    const Vector2d size = high_ - low_;
    const double edge = std::max(std::sqrt(size.x() * size.y() / static_cast<double>(faces.size())),
                                 size.maxCoeff() / k_most_cells_along);
    per_length_ = edge > 0.0 ? 1.0 / edge : 0.0;
    along_x_ = 1 + cell(high_.x(), low_.x());
    along_y_ = 1 + cell(high_.y(), low_.y());
    faces_of_cells_.resize(along_x_ * along_y_);
    for (const Face& f : faces) {
      for_each_cell(f, [&](std::size_t c, std::size_t, std::size_t) { faces_of_cells_[c].push_back(&f); });
    }
  }

  /// Calls take(g) once for every face g whose projection's box overlaps that of `f` in more than a line.
  template <class Take>
  void for_each_near(const Face& f, const Take& take) const {
    if (faces_of_cells_.empty() || (f.low.array() >= high_.array()).any() || (f.high.array() <= low_.array()).any())
      return;
    for_each_cell(f, [&](std::size_t c, std::size_t x, std::size_t y) {
      for (const Face* near : faces_of_cells_[c]) {
        const Face& g = *near;
        if ((g.low.array() >= f.high.array()).any() || (g.high.array() <= f.low.array()).any()) continue;
        // A pair may share several cells: it counts in the one with the lower corner of the boxes' intersection.
        if (cell(std::max(f.low.x(), g.low.x()), low_.x()) == x &&
            cell(std::max(f.low.y(), g.low.y()), low_.y()) == y) {
          take(g);
        }
      }
    });
  }

 private:
  static constexpr double k_most_cells_along = 4096;

  std::size_t cell(double at, double from) const {
    return static_cast<std::size_t>(std::clamp((at - from) * per_length_, 0.0, 2.0 * k_most_cells_along));
  }

  /// Calls take(index, x, y) for the cells of the grid that the box of `f` overlaps.
  template <class Take>
  void for_each_cell(const Face& f, const Take& take) const {
    const std::size_t end_x = std::min(along_x_ - 1, cell(f.high.x(), low_.x()));
    const std::size_t end_y = std::min(along_y_ - 1, cell(f.high.y(), low_.y()));
    for (std::size_t y = cell(f.low.y(), low_.y()); y <= end_y; ++y) {
      for (std::size_t x = cell(f.low.x(), low_.x()); x <= end_x; ++x) take(y * along_x_ + x, x, y);
    }
  }

  Vector2d low_ = Vector2d::Zero(), high_ = Vector2d::Zero();
  double per_length_ = 0.0;
  std::size_t along_x_ = 0, along_y_ = 0;
  std::vector<std::vector<const Face*>> faces_of_cells_;
};

}  // namespace

double overlap_volume_by_columns(const Mesh& a, const Mesh& b, const Pose& X_AB) {
  for (const Mesh* mesh : {&a, &b}) {
    if (!mesh->solid()) throw BadMesh(mesh->name() + ": " + mesh->why_not_solid() + k_repair_hint);
  }
  const Vector3d origin = a.center();
  const std::vector<Face> of_a = project(a, Pose{}, origin);
  const std::vector<Face> of_b = project(b, X_AB, origin);
  const FaceGrid grid(of_b);
  CompensatedSum sum;
  for (const Face& f : of_a) {
    grid.for_each_near(f, [&](const Face& g) { sum += f.sign * g.sign * integrate_lower(f, g); });
  }
  return sum.value();
}

}  // namespace sixdof
