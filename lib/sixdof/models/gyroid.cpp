#include <sixdof/models/recipe.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <unordered_map>
#include <vector>

#include <sixdof/geometry/sides.h>
#include <sixdof/models/cos_sin.h>
#include <sixdof/models/refine.h>
#include <sixdof/models/surface.h>

namespace sixdof {
namespace {

/// A scalar field on the nodes of a cubic grid: node (i, j, k) lies at low + step * (i, j, k), 0 <= i, j, k <= cells.
struct GridField {
  std::uint32_t cells = 0;  ///< Along each axis; a multiple of 8.
  double low = 0.0;         ///< First coordinate along every axis.
  double step = 1.0;
  /// Value at a node; negative inside the solid. Must be positive on the grid's border.
  std::function<double(std::uint32_t i, std::uint32_t j, std::uint32_t k)> value;
  double lipschitz = 1.0;  ///< Bound on the change of the value per length: blocks without a zero are skipped by it.
};

constexpr std::uint32_t k_block = 8;  // cells along an edge of a block that can be skipped

struct Node {
  std::array<std::uint32_t, 3> at;
  double value;
};

/// A tetrahedron of a cell: its corners are on the path from the cell's first to its last corner along the axes in this
/// order.
struct Path {
  std::array<std::size_t, 3> axes;
  bool right_handed;  ///< Orientation of the four corners.
};
constexpr std::array<Path, 6> k_paths{{{{0, 1, 2}, true},
                                       {{1, 2, 0}, true},
                                       {{2, 0, 1}, true},
                                       {{0, 2, 1}, false},
                                       {{1, 0, 2}, false},
                                       {{2, 1, 0}, false}}};

/// body(i, j, k) for all numbers below n.
template <class Body>
void for_each_triple(std::uint32_t n, const Body& body) {
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      for (std::uint32_t k = 0; k < n; ++k) body(i, j, k);
    }
  }
}

/// The surface value = 0 by marching tetrahedra: each cell is divided into six tetrahedra about its diagonal. Closed,
/// manifold and facing outwards for any values, since each node is either inside or outside; vertices are at least 1/20
/// of an edge away from the nodes. Triangles may be slim. Cost and memory grow with the area of the surface.
class Marcher {
 public:
  explicit Marcher(const GridField& field) : field_(field) {}

  RawMesh run() {
    for_each_triple(field_.cells / k_block, [this](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
      contour_block({i * k_block, j * k_block, k * k_block});
    });
    return std::move(surface_);
  }

 private:
  void contour_block(const std::array<std::uint32_t, 3>& first) {
    constexpr std::uint32_t k_half = k_block / 2;
    const double middle = field_.value(first[0] + k_half, first[1] + k_half, first[2] + k_half);
    const double radius = std::sqrt(3.0) * k_half * field_.step;
    if (std::abs(middle) > field_.lipschitz * radius) return;
    for_each_triple(k_block + 1, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
      values_[i][j][k] = field_.value(first[0] + i, first[1] + j, first[2] + k);
    });
    for_each_triple(k_block, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
      contour_cell(first, {i, j, k});
    });
  }

  void contour_cell(const std::array<std::uint32_t, 3>& first, const std::array<std::uint32_t, 3>& cell) {
    for (const Path& path : k_paths) {
      std::array<std::uint32_t, 3> local = cell;
      std::array<Node, 4> corners;
      for (std::size_t c = 0; c < 4; ++c) {
        if (c > 0) ++local[path.axes[c - 1]];
        corners[c] = {{first[0] + local[0], first[1] + local[1], first[2] + local[2]},
                      values_[local[0]][local[1]][local[2]]};
      }
      contour_tetrahedron(corners, path.right_handed);
    }
  }

  void contour_tetrahedron(std::array<Node, 4> corners, bool right_handed) {
    // Corners inside go first; every exchange of two corners changes the orientation.
    std::size_t inside = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      if (corners[c].value >= 0.0) continue;
      if (c != inside) {
        std::swap(corners[c], corners[inside]);
        right_handed = !right_handed;
      }
      ++inside;
    }
    const auto [a, b, c, d] = corners;
    if (inside == 1) {
      add(right_handed, cut(a, b), cut(a, c), cut(a, d));
    } else if (inside == 2) {
      const std::uint32_t ac = cut(a, c);
      const std::uint32_t bd = cut(b, d);
      add(right_handed, ac, cut(a, d), bd);
      add(right_handed, ac, bd, cut(b, c));
    } else if (inside == 3) {
      // The one corner that differs from the others is the last here, the first above: the orientation is the opposite.
      add(right_handed, cut(a, d), cut(b, d), cut(c, d));
    }
  }

  void add(bool right_handed, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    surface_.triangles.push_back(right_handed ? Triangle{x, y, z} : Triangle{x, z, y});
  }

  /// The vertex on the edge between two nodes, made on first use.
  std::uint32_t cut(const Node& p, const Node& q) {
    const bool in_order = p.at <= q.at;  // paths go upwards: no coordinate of `high` is less than that of `low`
    const Node& low = in_order ? p : q;
    const Node& high = in_order ? q : p;
    const std::uint64_t width = field_.cells + 1ULL;
    std::uint64_t key = (low.at[0] * width + low.at[1]) * width + low.at[2];
    for (std::size_t axis = 0; axis < 3; ++axis) key = 2 * key + (high.at[axis] - low.at[axis]);
    const auto [entry, fresh] = numbers_.try_emplace(key, static_cast<std::uint32_t>(surface_.vertices.size()));
    if (fresh) {
      constexpr double k_clear = 0.05;
      const double fraction = std::clamp(low.value / (low.value - high.value), k_clear, 1.0 - k_clear);
      Eigen::Vector3d position;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double steps = low.at[axis] + fraction * (high.at[axis] - low.at[axis]);
        position[static_cast<Eigen::Index>(axis)] = field_.low + field_.step * steps;
      }
      surface_.vertices.push_back(position);
    }
    return entry->second;
  }

  const GridField& field_;
  std::array<std::array<std::array<double, k_block + 1>, k_block + 1>, k_block + 1> values_{};
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
  RawMesh surface_;
};

/// Keeps the component of the surface with the most triangles only.
void keep_largest_component(RawMesh& surface) {
  UnionFind parts(surface.vertices.size());
  for (const Triangle& t : surface.triangles) {
    parts.join(t[1], t[0]);
    parts.join(t[2], t[0]);
  }
  std::vector<std::size_t> size(surface.vertices.size(), 0);
  for (const Triangle& t : surface.triangles) ++size[parts.find(t[0])];
  const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  RawMesh kept;
  constexpr std::uint32_t k_none = ~0U;
  std::vector<std::uint32_t> number(surface.vertices.size(), k_none);
  for (const Triangle& t : surface.triangles) {
    if (parts.find(t[0]) != largest) continue;
    Triangle& renumbered = kept.triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      if (number[t[c]] == k_none) number[t[c]] = kept.add(surface.vertices[t[c]]);
      renumbered[c] = number[t[c]];
    }
  }
  surface = std::move(kept);
}

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

RawMesh contour_of(const GyroidBallShape& shape, std::uint32_t cells) {
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
  return Marcher(field).run();
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
  RawMesh surface;
  while (true) {
    surface = contour_of(shape, cells);
    keep_largest_component(surface);
    if (static_cast<double>(surface.triangles.size()) >= wanted) break;
    cells += std::max(1U, cells / 80) * 8;
  }
  const SurfaceProjection onto = [&shape](const Eigen::Vector3d& p) { return project(shape, p); };
  for (Eigen::Vector3d& p : surface.vertices) p = onto(p);
  coarsen_to(surface, budget, onto);
  for (Eigen::Vector3d& p : surface.vertices) p *= shape.radius;
  return to_mesh(std::move(surface), "gyroid-ball");
}

}  // namespace sixdof
