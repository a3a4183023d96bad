#include <sixdof/models/recipe.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <sixdof/models/coarsen.h>
#include <sixdof/models/contour.h>
#include <sixdof/models/cos_sin.h>
#include <sixdof/models/sizing.h>
#include <sixdof/models/surface.h>

namespace sixdof {
namespace {

/// (cos, sin) of 2 pi x / period, along each axis.
struct Waves {
  Eigen::Vector2d x, y, z;
};

/// The field whose zeros are the surface: the smooth maximum (a + b + root) / 2, root = sqrt((a - b)^2 + rounding^2),
/// of the gyroid's field a, divided by its wave number to grow about as a distance does, and the ball's field b.
struct Field {
  double gyroid, ball, root, value;
};

double wave_number(const GyroidBallShape& shape) { return 2.0 * std::numbers::pi / shape.period; }

Field field_at(const GyroidBallShape& shape, const Eigen::Vector3d& p, const Waves& w) {
  const double gyroid = (w.x.y() * w.y.x() + w.y.y() * w.z.x() + w.z.y() * w.x.x()) / wave_number(shape);
  const double ball = 0.5 * (dot_in_order(p, p) - 1.0);
  const double root = std::sqrt((gyroid - ball) * (gyroid - ball) + shape.rounding * shape.rounding);
  return {gyroid, ball, root, 0.5 * (gyroid + ball + root)};
}

Waves waves_at(const GyroidBallShape& shape, const Eigen::Vector3d& p) {
  return {cos_sin(p.x() / shape.period), cos_sin(p.y() / shape.period), cos_sin(p.z() / shape.period)};
}

/// Onto the surface, by Newton's method along the gradient.
Eigen::Vector3d project(const GyroidBallShape& shape, Eigen::Vector3d p) {
  constexpr int k_most_steps = 20;
  constexpr double k_on_surface = 1e-14;  // of the radius: a hundred units in the last place
  for (int step = 0; step < k_most_steps; ++step) {
    const Waves w = waves_at(shape, p);
    const Field f = field_at(shape, p, w);
    if (std::abs(f.value) < k_on_surface) break;
    const Eigen::Vector3d slope(w.x.x() * w.y.x() - w.z.y() * w.x.y(), w.y.x() * w.z.x() - w.x.y() * w.y.y(),
                                w.z.x() * w.x.x() - w.y.y() * w.z.y());
    const double weight = 0.5 * (1.0 + (f.gyroid - f.ball) / f.root);
    const Eigen::Vector3d gradient = weight * slope + (1.0 - weight) * p;
    p -= f.value / dot_in_order(gradient, gradient) * gradient;
  }
  return p;
}

Surface contour_of(const GyroidBallShape& shape, std::uint32_t cells) {
  constexpr double k_half = 1.05;  // half the grid's width: the solid ends at 1
  GridField field;
  field.cells = cells;
  field.low = -k_half;
  field.step = 2.0 * k_half / cells;
  // Each component of the gyroid's gradient is below sqrt(2); the ball's gradient is the distance from the origin, at
  // most sqrt(3) * k_half.
  field.lipschitz = std::sqrt(6.0);
  std::vector<double> coordinate(cells + 1);
  std::vector<Eigen::Vector2d> wave(cells + 1);
  for (std::uint32_t i = 0; i <= cells; ++i) {
    coordinate[i] = field.low + field.step * i;
    wave[i] = cos_sin(coordinate[i] / shape.period);
  }
  field.value = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return field_at(shape, {coordinate[i], coordinate[j], coordinate[k]}, {wave[i], wave[j], wave[k]}).value;
  };
  return contour(field);
}

}  // namespace

Mesh make_gyroid_ball(const GyroidBallShape& shape, std::size_t triangles) {
  check_length("gyroid-ball", "radius", shape.radius);
  check_shape(shape.period >= 0.5 && shape.period <= 2.0, "gyroid-ball", "period must be from 0.5 to 2 radii");
  check_shape(shape.rounding >= 0.02 && shape.rounding <= 0.2, "gyroid-ball",
              "rounding must be from 0.02 to 0.2 radii");
  const std::size_t budget = triangle_budget("gyroid-ball", triangles, k_minimum_gyroid_ball);
  constexpr double k_surplus = 2.5;         // triangles before and after coarsening, which removes the slim ones
  constexpr std::uint32_t k_coarsest = 64;  // cells that resolve handles and rounded edges
  constexpr double k_triangles_per_square_of_cells = 40.0;  // of a contour, about
  const double wanted = k_surplus * static_cast<double>(budget);
  auto cells =
      std::max(k_coarsest, static_cast<std::uint32_t>(std::sqrt(wanted / k_triangles_per_square_of_cells)) / 8 * 8);
  Surface surface;
  while (true) {
    surface = contour_of(shape, cells);
    keep_largest_component(surface);
    if (static_cast<double>(surface.triangles.size()) >= wanted) break;
    cells += std::max(1U, cells / 80) * 8;
  }
  const Project onto = [&shape](const Eigen::Vector3d& p) { return project(shape, p); };
  for (Eigen::Vector3d& p : surface.vertices) p = onto(p);
  coarsen_to(surface, budget, onto);
  for (Eigen::Vector3d& p : surface.vertices) p *= shape.radius;
  return to_mesh(std::move(surface), "gyroid-ball");
}

}  // namespace sixdof
