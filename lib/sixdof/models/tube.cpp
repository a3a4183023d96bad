#include <sixdof/models/recipe.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include <sixdof/models/cos_sin.h>
#include <sixdof/models/refine.h>
#include <sixdof/models/surface.h>

namespace sixdof {
namespace {

constexpr double k_two_pi = 2.0 * std::numbers::pi;
constexpr std::uint32_t k_core_points = 1024;  // beyond twice the bandwidth of the speed of any knot that is allowed

/// A point of the core: position, first and second derivative by t.
struct CorePoint {
  Eigen::Vector3d position, first, second;
};

struct Frame {
  Eigen::Vector3d position, tangent, outward, across;  ///< The last three are orthonormal and right-handed.
};

CorePoint core_at(const TorusKnotShape& shape, double t) {
  const double p = k_two_pi * shape.revolutions;
  const double q = k_two_pi * shape.windings;
  const Eigen::Vector2d around = cos_sin(shape.revolutions * t);
  const Eigen::Vector2d about = cos_sin(shape.windings * t);
  const double r = shape.minor_radius;
  const double rho = shape.major_radius + r * about.x();
  const double rho1 = -r * q * about.y();
  const double rho2 = -r * q * q * about.x();
  const Eigen::Vector3d radial(around.x(), around.y(), 0.0);
  const Eigen::Vector3d sideways(-around.y(), around.x(), 0.0);
  const Eigen::Vector3d up(0.0, 0.0, 1.0);
  return {rho * radial + r * about.y() * up, rho1 * radial + rho * p * sideways + r * q * about.x() * up,
          (rho2 - rho * p * p) * radial + 2.0 * rho1 * p * sideways - r * q * q * about.y() * up};
}

/// From the tangent and the direction away from the z axis, which is never parallel to it: the frame is periodic and
/// has little twist.
Frame frame_at(const TorusKnotShape& shape, double t) {
  const CorePoint core = core_at(shape, t);
  const Eigen::Vector3d tangent = core.first / norm_in_order(core.first);
  const Eigen::Vector2d around = cos_sin(shape.revolutions * t);
  const Eigen::Vector3d radial(around.x(), around.y(), 0.0);
  Eigen::Vector3d outward = radial - dot_in_order(radial, tangent) * tangent;
  outward /= norm_in_order(outward);
  return {core.position, tangent, outward, tangent.cross(outward)};
}

/// Parameters t of `count` points that divide the core into parts of equal length, by linear interpolation in a table
/// of arc lengths; the first is 0.
std::vector<double> equal_parts(const TorusKnotShape& shape, std::uint32_t count) {
  constexpr std::uint32_t k_finer = 4;
  const std::uint32_t pieces = k_finer * count;
  std::vector<double> length(pieces + 1, 0.0);
  for (std::uint32_t i = 0; i < pieces; ++i) {
    const double middle = (i + 0.5) / pieces;
    length[i + 1] = length[i] + norm_in_order(core_at(shape, middle).first) / pieces;
  }
  std::vector<double> parameters(count, 0.0);
  std::uint32_t i = 0;
  for (std::uint32_t k = 1; k < count; ++k) {
    const double wanted = length[pieces] * k / count;
    while (length[i + 1] < wanted) ++i;
    parameters[k] = (i + (wanted - length[i]) / (length[i + 1] - length[i])) / pieces;
  }
  return parameters;
}

/// Length of the core, by the trapezium rule (exact to rounding for a periodic analytic curve).
/// @throws BadArgument if the tube intersects itself. Where the core's curvature is at most 1 / tube_radius, two points
/// that are less than half a circle of that radius apart along the core are no nearer than on the circle (Schur); all
/// other pairs are compared.
double check_clearance(const TorusKnotShape& shape) {
  std::vector<CorePoint> core(k_core_points);
  std::vector<double> along(k_core_points + 1, 0.0);
  for (std::uint32_t i = 0; i < k_core_points; ++i) {
    core[i] = core_at(shape, static_cast<double>(i) / k_core_points);
    const double speed = norm_in_order(core[i].first);
    along[i + 1] = along[i] + speed / k_core_points;
    const double curvature = norm_in_order(core[i].first.cross(core[i].second)) / (speed * speed * speed);
    check_shape(curvature * shape.tube_radius < 1.0, "torus-knot",
                "the tube is thicker than the core's curvature allows");
  }
  for (std::uint32_t i = 0; i < k_core_points; ++i) {
    for (std::uint32_t j = i + 1; j < k_core_points; ++j) {
      const double apart = std::min(along[j] - along[i], along[k_core_points] - along[j] + along[i]);
      if (apart < std::numbers::pi * shape.tube_radius) continue;
      check_shape(norm_in_order(core[i].position - core[j].position) > 2.0 * shape.tube_radius, "torus-knot",
                  "strands of the tube meet");
    }
  }
  return along[k_core_points];
}

struct Counts {
  std::uint32_t along, around;
};

/// Rows along the core and vertices around the tube within a budget of triangles. Rows are staggered: their number is
/// even.
Counts fit_counts(double core, double tube_radius, std::size_t budget, Counts fewest) {
  const auto counts_for = [&](double h) -> Counts {
    return {2 * whole_steps(core, 2.0 * k_row * h, fewest.along / 2),
            whole_steps(k_two_pi * tube_radius, h, fewest.around)};
  };
  return counts_for(fit_edge_length(core * k_two_pi * tube_radius, budget, [&](double h) {
    const Counts c = counts_for(h);
    return std::size_t{2} * c.along * c.around;
  }));
}

void stitch_all(RawMesh& surface, const Counts& counts) {
  for (std::uint32_t i = 0; i < counts.along; ++i) {
    const std::uint32_t next = (i + 1) % counts.along;
    stitch(surface, {i * counts.around, counts.around, i % 2}, {next * counts.around, counts.around, next % 2});
  }
}

constexpr Counts k_fewest_torus{6, 5};
static_assert(2 * k_fewest_torus.along * k_fewest_torus.around == k_minimum_torus);
constexpr Counts k_fewest_torus_knot{60, 5};
static_assert(2 * k_fewest_torus_knot.along * k_fewest_torus_knot.around == k_minimum_torus_knot);

}  // namespace

Mesh make_torus(const TorusShape& shape, std::size_t triangles) {
  check_length("torus", "major_radius", shape.major_radius);
  check_length("torus", "minor_radius", shape.minor_radius);
  check_shape(shape.minor_radius < shape.major_radius, "torus", "minor_radius must be less than major_radius");
  const std::size_t budget = triangle_budget("torus", triangles, k_minimum_torus);
  const double core = k_two_pi * shape.major_radius;
  const double r = shape.minor_radius;
  const Counts counts = fit_counts(core, r, budget, k_fewest_torus);
  RawMesh surface;
  for (std::uint32_t i = 0; i < counts.along; ++i) {
    const Eigen::Vector2d around = cos_sin(i, counts.along);
    for (std::uint32_t j = 0; j < counts.around; ++j) {
      // Counter-clockwise seen against the core's direction, as stitch() needs: first outwards, then downwards.
      const Eigen::Vector2d about = cos_sin(2ULL * j + i % 2, 2ULL * counts.around);
      const double rho = shape.major_radius + r * about.x();
      surface.vertices.emplace_back(rho * around.x(), rho * around.y(), -r * about.y());
    }
  }
  stitch_all(surface, counts);
  refine_to(surface, budget, [&](const RawMesh& s, std::uint32_t a, std::uint32_t b) {
    const Eigen::Vector3d p = midpoint_of_edge(s, a, b);
    const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
    const Eigen::Vector3d core_point(shape.major_radius / rho * p.x(), shape.major_radius / rho * p.y(), 0.0);
    const Eigen::Vector3d out = p - core_point;
    return Eigen::Vector3d(core_point + r / norm_in_order(out) * out);
  });
  return to_mesh(std::move(surface), "torus");
}

Mesh make_torus_knot(const TorusKnotShape& shape, std::size_t triangles) {
  check_length("torus-knot", "major_radius", shape.major_radius);
  check_length("torus-knot", "minor_radius", shape.minor_radius);
  check_length("torus-knot", "tube_radius", shape.tube_radius);
  check_shape(shape.revolutions >= 1 && shape.windings >= 1 && shape.revolutions <= 20 && shape.windings <= 20 &&
                  std::gcd(shape.revolutions, shape.windings) == 1,
              "torus-knot", "revolutions and windings must be from 1 to 20 without a common divisor");
  check_shape(shape.minor_radius < shape.major_radius, "torus-knot", "minor_radius must be less than major_radius");
  const double core = check_clearance(shape);
  const std::size_t budget = triangle_budget("torus-knot", triangles, k_minimum_torus_knot);
  const double radius = shape.tube_radius;
  const Counts counts = fit_counts(core, radius, budget, k_fewest_torus_knot);
  RawMesh surface;
  std::vector<double> parameter;  // of the ring that each vertex lies on
  const std::vector<double> rows = equal_parts(shape, counts.along);
  for (std::uint32_t i = 0; i < counts.along; ++i) {
    const Frame frame = frame_at(shape, rows[i]);
    for (std::uint32_t j = 0; j < counts.around; ++j) {
      const Eigen::Vector2d about = cos_sin(2ULL * j + i % 2, 2ULL * counts.around);
      surface.vertices.emplace_back(frame.position + radius * (about.x() * frame.outward + about.y() * frame.across));
      parameter.push_back(rows[i]);
    }
  }
  stitch_all(surface, counts);
  refine_to(surface, budget, [&](const RawMesh& s, std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(parameter[a], parameter[b]);
    const double t = high - low > 0.5 ? 0.5 * (low + 1.0 + high) : 0.5 * (low + high);
    parameter.push_back(t < 1.0 ? t : t - 1.0);
    const Frame frame = frame_at(shape, t);
    Eigen::Vector3d out = midpoint_of_edge(s, a, b) - frame.position;
    out -= dot_in_order(out, frame.tangent) * frame.tangent;
    return Eigen::Vector3d(frame.position + radius / norm_in_order(out) * out);
  });
  return to_mesh(std::move(surface), "torus-knot");
}

}  // namespace sixdof
