#include <sixdof/models/recipe.h>

#include <array>
#include <cmath>
#include <functional>
#include <unordered_map>
#include <vector>

#include <sixdof/models/cos_sin.h>
#include <sixdof/models/refine.h>
#include <sixdof/models/surface.h>

namespace sixdof {
namespace {

/// A block of cells, some of which are solid; it may be bent and closed to a ring. Along each axis cell i is divided
/// into steps[axis][i] steps, in which the walls between solid and empty cells are tessellated.
struct Lattice {
  using Node = std::array<std::uint32_t, 3>;  ///< Cell numbers, or steps from the start along each axis.

  std::array<std::vector<std::uint32_t>, 3> steps;
  bool ring = false;  ///< Along axis 1 the last cell is followed by the first.
  std::function<bool(const Node& cell)> solid;
  /// Position of a node; axes 0, 1, 2 are right-handed. A wall is flat if the positions of its nodes are coplanar.
  std::function<Eigen::Vector3d(const Node& node)> position;
};

/// The wall of a solid cell towards lower or higher numbers on `axis`.
struct Wall {
  Lattice::Node cell;
  std::size_t axis;
  bool towards_higher;
};

template <class Body>
void for_each_wall(const Lattice& lattice, Body body) {
  const std::array<std::uint32_t, 3> size{static_cast<std::uint32_t>(lattice.steps[0].size()),
                                          static_cast<std::uint32_t>(lattice.steps[1].size()),
                                          static_cast<std::uint32_t>(lattice.steps[2].size())};
  Lattice::Node cell;
  for (cell[0] = 0; cell[0] < size[0]; ++cell[0]) {
    for (cell[1] = 0; cell[1] < size[1]; ++cell[1]) {
      for (cell[2] = 0; cell[2] < size[2]; ++cell[2]) {
        if (!lattice.solid(cell)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const bool towards_higher : {false, true}) {
            const bool closes = lattice.ring && axis == 1;
            const bool at_end = towards_higher ? cell[axis] + 1 == size[axis] : cell[axis] == 0;
            Lattice::Node beyond = cell;
            beyond[axis] = (cell[axis] + (towards_higher ? 1 : size[axis] - 1)) % size[axis];
            if ((at_end && !closes) || !lattice.solid(beyond)) body(Wall{cell, axis, towards_higher});
          }
        }
      }
    }
  }
}

double distance_squared(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = a - b;
  return dot_in_order(along, along);
}

/// The surface between solid and empty cells, facing the empty ones: two triangles per wall element, divided along its
/// shorter diagonal. It is manifold unless two solid cells touch in an edge or corner only.
class Builder {
 public:
  explicit Builder(const Lattice& lattice) : lattice_(lattice) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      start_[axis].push_back(0);
      for (const std::uint32_t s : lattice.steps[axis]) start_[axis].push_back(start_[axis].back() + s);
    }
  }

  RawMesh build() {
    for_each_wall(lattice_, [this](const Wall& wall) { add(wall); });
    return std::move(surface_);
  }

 private:
  void add(const Wall& wall) {
    const std::size_t u = (wall.axis + 1) % 3;
    const std::size_t v = (wall.axis + 2) % 3;
    Lattice::Node node;
    node[wall.axis] = start_[wall.axis][wall.cell[wall.axis] + (wall.towards_higher ? 1 : 0)];
    for (std::uint32_t i = start_[u][wall.cell[u]]; i < start_[u][wall.cell[u] + 1]; ++i) {
      for (std::uint32_t j = start_[v][wall.cell[v]]; j < start_[v][wall.cell[v] + 1]; ++j) {
        const auto corner = [&](std::uint32_t di, std::uint32_t dj) {
          node[u] = i + di;
          node[v] = j + dj;
          return vertex(node);
        };
        const std::uint32_t a = corner(0, 0);
        const std::uint32_t b = corner(1, 0);
        const std::uint32_t c = corner(1, 1);
        const std::uint32_t d = corner(0, 1);
        wall.towards_higher ? add_quad(a, b, c, d) : add_quad(a, d, c, b);
      }
    }
  }

  std::uint32_t vertex(Lattice::Node node) {
    if (lattice_.ring && node[1] == start_[1].back()) node[1] = 0;
    const std::uint64_t width = start_[2].back() + 1ULL;
    const std::uint64_t key = (node[0] * (start_[1].back() + 1ULL) + node[1]) * width + node[2];
    const auto [entry, fresh] = numbers_.try_emplace(key, static_cast<std::uint32_t>(surface_.vertices.size()));
    if (fresh) surface_.add(lattice_.position(node));
    return entry->second;
  }

  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const auto& p = surface_.vertices;
    if (distance_squared(p[a], p[c]) <= distance_squared(p[b], p[d])) {
      surface_.triangles.push_back({a, b, c});
      surface_.triangles.push_back({a, c, d});
    } else {
      surface_.triangles.push_back({b, c, d});
      surface_.triangles.push_back({b, d, a});
    }
  }

  const Lattice& lattice_;
  std::array<std::vector<std::uint32_t>, 3> start_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
  RawMesh surface_;
};

std::size_t count_triangles(const Lattice& lattice) {
  std::size_t sum = 0;
  for_each_wall(lattice, [&](const Wall& wall) {
    const std::size_t u = (wall.axis + 1) % 3;
    const std::size_t v = (wall.axis + 2) % 3;
    sum += 2ULL * lattice.steps[u][wall.cell[u]] * lattice.steps[v][wall.cell[v]];
  });
  return sum;
}

Lattice lattice_of(const BoxShape& shape, double h) {
  Lattice lattice;
  for (int axis = 0; axis < 3; ++axis) lattice.steps[axis] = {whole_steps(shape.size[axis], h, 1)};
  lattice.solid = [](const Lattice::Node&) { return true; };
  lattice.position = [size = shape.size, steps = lattice.steps](const Lattice::Node& node) {
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis) {
      const double fraction = static_cast<double>(node[axis]) / static_cast<double>(steps[axis][0]);
      p[axis] = (fraction - 0.5) * size[axis];
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

/// @param area of the surface, about: where the search for the edge length starts
template <class Shape>
Mesh tessellate(const Shape& shape, double area, std::size_t budget, const char* name) {
  const double h = fit_edge_length(area, budget, [&](double edge) { return count_triangles(lattice_of(shape, edge)); });
  const Lattice lattice = lattice_of(shape, h);
  RawMesh surface = Builder(lattice).build();
  refine_to(surface, budget);
  return to_mesh(std::move(surface), name);
}

}  // namespace

Mesh make_box(const BoxShape& shape, std::size_t triangles) {
  for (const double length : shape.size) check_length("box", "size", length);
  const Eigen::Vector3d& s = shape.size;
  const double area = 2.0 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
  return tessellate(shape, area, triangle_budget("box", triangles, k_minimum_box), "box");
}

Mesh make_circular_box(const CircularBoxShape& shape, std::size_t triangles) {
  check(shape);
  const std::size_t budget = triangle_budget("circular-box", triangles, minimum_triangles(shape));
  return tessellate(shape, 8.0 * shape.sectors * shape.beam * (shape.outer_radius + shape.height), budget,
                    "circular-box");
}

}  // namespace sixdof
