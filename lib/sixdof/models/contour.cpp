#include <sixdof/models/contour.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include <sixdof/geometry/sides.h>

namespace sixdof {
namespace {

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

class Marcher {
 public:
  explicit Marcher(const GridField& field) : field_(field) {}

  Surface run() {
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
  Surface surface_;
};

}  // namespace

Surface contour(const GridField& field) { return Marcher(field).run(); }

void keep_largest_component(Surface& surface) {
  UnionFind parts(surface.vertices.size());
  for (const Triangle& t : surface.triangles) {
    parts.join(t[1], t[0]);
    parts.join(t[2], t[0]);
  }
  std::vector<std::size_t> size(surface.vertices.size(), 0);
  for (const Triangle& t : surface.triangles) ++size[parts.find(t[0])];
  const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  Surface kept;
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

}  // namespace sixdof
