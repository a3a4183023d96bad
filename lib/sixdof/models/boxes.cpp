#include <sixdof/models/boxes.h>

#include <cmath>

#include <sixdof/models/cos_sin.h>
#include <sixdof/models/lattice.h>
#include <sixdof/models/refine.h>
#include <sixdof/models/sizing.h>

namespace sixdof {
namespace {

Lattice lattice_of(const BoxShape& shape, double h) {
  Lattice lattice;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lattice.steps[axis] = {whole_steps(shape.size[static_cast<Eigen::Index>(axis)], h, 1)};
  }
  lattice.solid = [](const Lattice::Node&) { return true; };
  lattice.position = [size = shape.size, steps = lattice.steps](const Lattice::Node& node) {
    Eigen::Vector3d p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double fraction = static_cast<double>(node[axis]) / static_cast<double>(steps[axis][0]);
      p[static_cast<Eigen::Index>(axis)] = (fraction - 0.5) * size[static_cast<Eigen::Index>(axis)];
    }
    return p;
  };
  return lattice;
}

/// Borders of the circular box's cells along the radius or z: beam, opening, beam.
std::array<double, 4> borders(double low, double high, double beam) { return {low, low + beam, high - beam, high}; }

/// Angle, in revolutions, at which cell k around the circle starts: frames have even numbers, openings odd ones.
double start_of(const CircularBoxShape& shape, std::uint32_t k) {
  return (k / 2 + (k % 2 == 0 ? 0.0 : shape.frame_fraction)) / shape.sectors;
}

/// A cell is solid if at least two of its coordinates lie in the range of a beam or frame.
bool is_beam(const Lattice::Node& cell) {
  return (cell[0] != 1 ? 1 : 0) + (cell[1] % 2 == 0 ? 1 : 0) + (cell[2] != 1 ? 1 : 0) >= 2;
}

/// The cell that holds a node, and the node's position in it from 0 to 1.
struct InCell {
  std::uint32_t cell;
  double fraction;
};

InCell locate(const std::vector<std::uint32_t>& steps, std::uint32_t node) {
  std::uint32_t cell = 0;
  while (cell + 1 < steps.size() && node >= steps[cell]) node -= steps[cell++];
  return {cell, static_cast<double>(node) / static_cast<double>(steps[cell])};
}

double interpolate(double low, double high, double fraction) { return (1.0 - fraction) * low + fraction * high; }

Lattice lattice_of(const CircularBoxShape& shape, double h) {
  const auto radii = borders(shape.inner_radius, shape.outer_radius, shape.beam);
  const auto heights = borders(-0.5 * shape.height, 0.5 * shape.height, shape.beam);
  Lattice lattice;
  lattice.ring = true;
  for (std::size_t i = 0; i < 3; ++i) {
    lattice.steps[0].push_back(whole_steps(radii[i + 1] - radii[i], h, 1));
    lattice.steps[2].push_back(whole_steps(heights[i + 1] - heights[i], h, 1));
  }
  const double middle_radius = 0.5 * (shape.inner_radius + shape.outer_radius);
  for (std::uint32_t k = 0; k < 2 * shape.sectors; ++k) {
    const Eigen::Vector2d chord = cos_sin(start_of(shape, k + 1)) - cos_sin(start_of(shape, k));
    const double length = middle_radius * std::sqrt(chord.x() * chord.x() + chord.y() * chord.y());
    lattice.steps[1].push_back(whole_steps(length, h, 1));
  }
  lattice.solid = is_beam;
  lattice.position = [shape, radii, heights, steps = lattice.steps](const Lattice::Node& node) {
    const InCell along_radius = locate(steps[0], node[0]);
    const InCell around = locate(steps[1], node[1]);
    const InCell up = locate(steps[2], node[2]);
    // Along the chord from corner to corner: walls are flat.
    const Eigen::Vector2d from = cos_sin(start_of(shape, around.cell));
    const Eigen::Vector2d to = cos_sin(start_of(shape, around.cell + 1));
    const double radius = interpolate(radii[along_radius.cell], radii[along_radius.cell + 1], along_radius.fraction);
    return Eigen::Vector3d(radius * interpolate(from.x(), to.x(), around.fraction),
                           radius * interpolate(from.y(), to.y(), around.fraction),
                           interpolate(heights[up.cell], heights[up.cell + 1], up.fraction));
  };
  return lattice;
}

void check(const CircularBoxShape& shape) {
  check_length("circular-box", "outer_radius", shape.outer_radius);
  check_length("circular-box", "inner_radius", shape.inner_radius);
  check_length("circular-box", "height", shape.height);
  check_length("circular-box", "beam", shape.beam);
  check_shape(shape.sectors >= 3 && shape.sectors <= 1000, "circular-box", "sectors must be from 3 to 1000");
  check_shape(shape.frame_fraction > 0.0 && shape.frame_fraction < 1.0, "circular-box",
              "frame_fraction must be within 0 and 1");
  check_shape(2.0 * shape.beam < shape.outer_radius - shape.inner_radius, "circular-box",
              "two beams must be thinner than outer_radius - inner_radius");
  check_shape(2.0 * shape.beam < shape.height, "circular-box", "two beams must be thinner than height");
}

}  // namespace

std::size_t minimum_triangles(const CircularBoxShape& shape) { return 80ULL * shape.sectors; }

Mesh make_box(const BoxShape& shape, std::size_t triangles) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) check_length("box", "size", shape.size[axis]);
  const std::size_t budget = triangle_budget("box", triangles, k_minimum_box);
  const Eigen::Vector3d& s = shape.size;
  const double area = 2.0 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
  const double h = fit_edge_length(area, budget, [&](double edge) { return count_triangles(lattice_of(shape, edge)); });
  Surface surface = surface_of(lattice_of(shape, h));
  refine_to(surface, budget);
  return to_mesh(std::move(surface), "box");
}

Mesh make_circular_box(const CircularBoxShape& shape, std::size_t triangles) {
  check(shape);
  const std::size_t budget = triangle_budget("circular-box", triangles, minimum_triangles(shape));
  // Approximate: the area gives only the start of the search for the edge length.
  const double area = 8.0 * shape.sectors * shape.beam * (shape.outer_radius + shape.height);
  const double h = fit_edge_length(area, budget, [&](double edge) { return count_triangles(lattice_of(shape, edge)); });
  Surface surface = surface_of(lattice_of(shape, h));
  refine_to(surface, budget);
  return to_mesh(std::move(surface), "circular-box");
}

}  // namespace sixdof
