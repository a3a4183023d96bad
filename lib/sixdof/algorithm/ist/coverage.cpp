#include <sixdof/algorithm/ist/coverage.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <queue>

namespace sixdof::ist {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// Greatest distance from a point to a triangle.
double reach(const Eigen::Vector3d& p, const Corners& t) {
  return std::max({(t[0] - p).norm(), (t[1] - p).norm(), (t[2] - p).norm()});
}

/// A part of a triangle, and a bound on its gaps: a gap grows no faster than the distance from where it is known.
struct Patch {
  Corners corners;
  double upper;

  bool operator<(const Patch& other) const { return upper < other.upper; }
};

/// Branch and bound over the triangles and their quarters.
class GapSearch {
 public:
  explicit GapSearch(std::span<const Sphere> spheres)
      : index_(std::ranges::max_element(spheres, {}, &Sphere::radius)->radius), last_(spheres.front().center) {
    for (const Sphere& sphere : spheres) index_.insert(sphere);
  }

  void look_at(const Eigen::Vector3d& p) {
    constexpr double k_above = 1.001;  // the gap is below the limit, not at it
    const double limit = k_above * (gap_at_last_ + (p - last_).norm());
    last_ = p;
    gap_at_last_ = std::max(0.0, index_.nearest(p, limit).clearance);
    greatest_ = std::max(greatest_, gap_at_last_);
  }

  /// Often the point that was looked at last lies so near that the triangle need not be.
  void add(const Corners& t) {
    if (gap_at_last_ + reach(last_, t) <= enough()) return;
    look_at((t[0] + t[1] + t[2]) / 3.0);
    patches_.push({t, gap_at_last_ + reach(last_, t)});
  }

  /// Divides the patches until none may exceed the tolerance.
  double solve() {
    for (std::size_t i = 0; i < k_most_divided && !patches_.empty() && patches_.top().upper > enough(); ++i) {
      const Corners t = patches_.top().corners;
      patches_.pop();
      const Eigen::Vector3d ab = 0.5 * (t[0] + t[1]), bc = 0.5 * (t[1] + t[2]), ca = 0.5 * (t[2] + t[0]);
      for (const Corners& quarter : {Corners{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}) add(quarter);
    }
    return patches_.empty() ? enough() : std::max(enough(), patches_.top().upper);
  }

 private:
  static constexpr std::size_t k_most_divided = 1'000'000;  // beyond it the bound is true but loose

  double enough() const { return (1.0 + k_gap_tolerance) * greatest_; }

  SphereIndex index_;
  std::priority_queue<Patch> patches_;
  Eigen::Vector3d last_;
  double gap_at_last_ = 0.0;
  double greatest_ = 0.0;  ///< That was found.
};

}  // namespace

double largest_gap(const Mesh& mesh, std::span<const Sphere> spheres) {
  constexpr std::size_t k_first_points = 1000;  // a large gap that is known early spares looking at most triangles
  const auto& points = mesh.vertices();
  GapSearch search(spheres);
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / k_first_points) search.look_at(points[i]);
  for (const auto& [a, b, c] : mesh.triangles()) search.add({points[a], points[b], points[c]});
  return search.solve();
}

}  // namespace sixdof::ist
