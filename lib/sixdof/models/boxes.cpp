#include <sixdof/models/boxes.h>

#include <cmath>

#include <sixdof/models/lattice.h>
#include <sixdof/models/lengths.h>
#include <sixdof/models/refine.h>
#include <sixdof/models/turn.h>

namespace sixdof {
namespace {

Mesh finish(Surface surface, std::size_t budget, const char* name) {
  refine_to(surface, budget);
  return Mesh::build(std::move(surface.vertices), std::move(surface.triangles), name);
}

Lattice lattice_of(const BoxShape& shape, double h) {
  Lattice lattice;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lattice.steps[axis] = {whole_steps(shape.size[static_cast<Eigen::Index>(axis)], h, 1)};
  }
  lattice.solid = [](const Lattice::Node&) { return true; };
  lattice.position = [size = shape.size, steps = lattice.steps](const Lattice::Node& node) {
    Eigen::Vector3d p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double share = static_cast<double>(node[axis]) / static_cast<double>(steps[axis][0]);
      p[static_cast<Eigen::Index>(axis)] = (share - 0.5) * size[static_cast<Eigen::Index>(axis)];
    }
    return p;
  };
  return lattice;
}

/// Borders of the circular box's cells along the radius and z, beam - opening - beam.
std::array<double, 4> borders(double low, double high, double beam) { return {low, low + beam, high - beam, high}; }

/// Angle, in turns, at which cell k of the circle starts: frames have even numbers, openings odd ones.
double start_of(const CircularBoxShape& shape, std::uint32_t k) {
  return (k / 2 + (k % 2 == 0 ? 0.0 : shape.frame_share)) / shape.sectors;
}

/// Solid where beams are: at least two of the three coordinates lie in a beam's or frame's range.
bool is_beam(const Lattice::Node& cell) {
  return (cell[0] != 1 ? 1 : 0) + (cell[1] % 2 == 0 ? 1 : 0) + (cell[2] != 1 ? 1 : 0) >= 2;
}

/// The cell that holds a node, and the node's share of the way through it.
struct Within {
  std::uint32_t cell;
  double share;
};

Within locate(const std::vector<std::uint32_t>& steps, std::uint32_t node) {
  std::uint32_t cell = 0;
  while (cell + 1 < steps.size() && node >= steps[cell]) node -= steps[cell++];
  return {cell, static_cast<double>(node) / static_cast<double>(steps[cell])};
}

double between(double low, double high, double share) { return (1.0 - share) * low + share * high; }

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
    const Eigen::Vector2d chord = unit_at(start_of(shape, k + 1)) - unit_at(start_of(shape, k));
    const double length = middle_radius * std::sqrt(chord.x() * chord.x() + chord.y() * chord.y());
    lattice.steps[1].push_back(whole_steps(length, h, 1));
  }
  lattice.solid = is_beam;
  lattice.position = [shape, radii, heights, steps = lattice.steps](const Lattice::Node& node) {
    const Within along_radius = locate(steps[0], node[0]);
    const Within around = locate(steps[1], node[1]);
    const Within up = locate(steps[2], node[2]);
    // Straight from corner to corner, not along the circle: walls are flat.
    const Eigen::Vector2d from = unit_at(start_of(shape, around.cell));
    const Eigen::Vector2d to = unit_at(start_of(shape, around.cell + 1));
    const double radius = between(radii[along_radius.cell], radii[along_radius.cell + 1], along_radius.share);
    return Eigen::Vector3d(radius * between(from.x(), to.x(), around.share),
                           radius * between(from.y(), to.y(), around.share),
                           between(heights[up.cell], heights[up.cell + 1], up.share));
  };
  return lattice;
}

void check(const CircularBoxShape& shape) {
  check_length("circular-box", "outer_radius", shape.outer_radius);
  check_length("circular-box", "inner_radius", shape.inner_radius);
  check_length("circular-box", "height", shape.height);
  check_length("circular-box", "beam", shape.beam);
  check_shape(shape.sectors >= 3 && shape.sectors <= 1000, "circular-box", "sectors must be from 3 to 1000");
  check_shape(shape.frame_share > 0.0 && shape.frame_share < 1.0, "circular-box", "frame_share must be within 0 and 1");
  check_shape(2.0 * shape.beam < shape.outer_radius - shape.inner_radius, "circular-box",
              "two beams must be thinner than outer_radius - inner_radius");
  check_shape(2.0 * shape.beam < shape.height, "circular-box", "two beams must be thinner than height");
}

}  // namespace

std::size_t minimum_triangles(const CircularBoxShape& shape) { return 80ULL * shape.sectors; }

double volume_of(const CircularBoxShape& shape) {
  check(shape);
  const auto radii = borders(shape.inner_radius, shape.outer_radius, shape.beam);
  const auto heights = borders(-0.5 * shape.height, 0.5 * shape.height, shape.beam);
  double volume = 0.0;
  Lattice::Node cell;
  for (cell[0] = 0; cell[0] < 3; ++cell[0]) {
    for (cell[1] = 0; cell[1] < 2; ++cell[1]) {
      for (cell[2] = 0; cell[2] < 3; ++cell[2]) {
        if (!is_beam(cell)) continue;
        // A ring's sector between two chords: (r_out^2 - r_in^2) / 2 times the sine of its angle.
        const double sine = unit_at(start_of(shape, cell[1] + 1) - start_of(shape, cell[1])).y();
        const double base = 0.5 * sine * (radii[cell[0] + 1] * radii[cell[0] + 1] - radii[cell[0]] * radii[cell[0]]);
        volume += base * (heights[cell[2] + 1] - heights[cell[2]]);
      }
    }
  }
  return shape.sectors * volume;
}

Mesh make_box(const BoxShape& shape, std::size_t triangles) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) check_length("box", "size", shape.size[axis]);
  const std::size_t budget = triangle_budget("box", triangles, k_minimum_box);
  const Eigen::Vector3d& s = shape.size;
  const double area = 2.0 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
  const double h = fit_edge_length(area, budget, [&](double edge) { return count_triangles(lattice_of(shape, edge)); });
  return finish(surface_of(lattice_of(shape, h)), budget, "box");
}

Mesh make_circular_box(const CircularBoxShape& shape, std::size_t triangles) {
  check(shape);
  const std::size_t budget = triangle_budget("circular-box", triangles, minimum_triangles(shape));
  // About: the area only starts the search for the edge length, which corrects it.
  const double area = 8.0 * shape.sectors * shape.beam * (shape.outer_radius + shape.height);
  const double h = fit_edge_length(area, budget, [&](double edge) { return count_triangles(lattice_of(shape, edge)); });
  return finish(surface_of(lattice_of(shape, h)), budget, "circular-box");
}

}  // namespace sixdof
