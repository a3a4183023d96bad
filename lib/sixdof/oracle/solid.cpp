#include <sixdof/oracle/solid.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/predicates.h>
#include <sixdof/geometry/sides.h>

namespace sixdof {
namespace {

constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();

/// Bits of a potential as large as the sum of all fluxes' magnitudes. The rest of the 127 is for curves that cross an
/// edge many times.
constexpr int k_potential_bits = 96;

void check(const Mesh& mesh) {
  if (!mesh.solid()) throw BadMesh(mesh.name() + ": " + mesh.why_not_solid() + k_repair_hint);
  for (std::size_t i = 0; i < mesh.vertices().size(); ++i) {
    for (const double x : mesh.vertices()[i]) {
      if (x != 0.0 && (std::abs(x) < k_smallest_exact_coordinate || std::abs(x) > k_largest_exact_coordinate)) {
        throw BadMesh(
            fmt::format("{}: vertex {}: coordinate {} is outside the range of exact predicates", mesh.name(), i, x));
      }
    }
  }
}

/// For each half-edge 3 t + k (from corner k to the next) the opposite half-edge. At edges with more than two triangles
/// half-edges are paired in order: any pairing of opposite directions makes a closed surface.
std::vector<std::uint32_t> pair_half_edges(const Mesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh.triangles());
  std::vector<std::uint32_t> twin(sides.size(), k_none);
  for_each_edge(sides, [&](std::span<const Side> edge) {
    for (std::size_t i = 0; i < edge.size(); ++i) {
      const Side& side = edge[i];
      if (twin[side.corner] != k_none) continue;
      const auto other = std::find_if(edge.begin() + static_cast<std::ptrdiff_t>(i), edge.end(), [&](const Side& x) {
        return twin[x.corner] == k_none && x.forward != side.forward;
      });
      if (other == edge.end()) continue;
      twin[side.corner] = other->corner;
      twin[other->corner] = side.corner;
    }
  });
  return twin;
}

std::uint32_t highest_vertex(const Triangle& t) { return std::max({t[0], t[1], t[2]}); }

/// Appends the triangle `root` to `queue`, then, breadth first, each neighbour for which enter(the half-edge from the
/// neighbour back) is true.
template <class Enter>
void flood(std::uint32_t root, const std::vector<std::uint32_t>& twin, std::vector<std::uint32_t>& queue,
           const Enter& enter) {
  std::size_t next = queue.size();
  queue.push_back(root);
  for (; next < queue.size(); ++next) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t back = twin[3 * queue[next] + k];
      if (enter(back)) queue.push_back(back / 3);
    }
  }
}

/// Of each connected piece the triangle with the pole, its vertex of highest index. Far from the centre: then it most
/// often lies outside the other body's box, where the winding number is 0.
std::vector<std::uint32_t> find_pole_triangles(const Mesh& mesh, const Eigen::Vector3d& center,
                                               const std::vector<std::uint32_t>& twin) {
  const std::vector<Triangle>& triangles = mesh.triangles();
  const auto distance = [&](std::uint32_t t) {
    return (mesh.vertices()[highest_vertex(triangles[t])] - center).squaredNorm();
  };
  std::vector<std::uint32_t> poles;
  std::vector<std::uint32_t> piece;
  std::vector<bool> seen(triangles.size(), false);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (seen[t]) continue;
    seen[t] = true;
    piece.clear();
    flood(t, twin, piece, [&](std::uint32_t back) {
      if (seen[back / 3]) return false;
      seen[back / 3] = true;
      return true;
    });
    poles.push_back(*std::max_element(piece.begin(), piece.end(),
                                      [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); }));
  }
  return poles;
}

/// A spanning tree of the triangles of each piece.
struct SpanningTrees {
  std::vector<std::uint32_t> triangles;  ///< Parents before children.
  std::vector<std::uint32_t> to_parent;  ///< Per triangle: its half-edge beside the parent; k_none for roots.

  SpanningTrees(const std::vector<std::uint32_t>& roots, const std::vector<std::uint32_t>& twin)
      : to_parent(twin.size() / 3, k_none) {
    triangles.reserve(to_parent.size());
    for (const std::uint32_t root : roots) {
      flood(root, twin, triangles, [&](std::uint32_t back) {
        const std::uint32_t t = back / 3;
        if (t == root || to_parent[t] != k_none) return false;
        to_parent[t] = back;
        return true;
      });
    }
  }
};

Solid::Integer to_fixed(double x, int exponent) { return static_cast<Solid::Integer>(std::ldexp(x, exponent)); }

/// Exponent e such that total * 2^e has k_potential_bits bits.
int fixed_exponent(double total) {
  int exponent = 0;
  std::frexp(total, &exponent);
  return k_potential_bits - exponent;
}

}  // namespace

Solid::Solid(const Mesh& mesh, const Tree& tree) : mesh_(&mesh), tree_(&tree) {
  check(mesh);
  const std::vector<std::uint32_t> twin = pair_half_edges(mesh);
  const std::vector<std::uint32_t> poles = find_pole_triangles(mesh, tree.center(), twin);
  const SpanningTrees spanning(poles, twin);
  // Fluxes are summed from the leaves of the spanning trees to their roots, the poles. The sum at a triangle is the
  // potential of its edge to the parent; edges outside the spanning trees have potential 0.
  std::vector<Potential> sums = triangle_fluxes();
  for (std::size_t i = sums.size(); i-- > 0;) {
    const std::uint32_t t = spanning.triangles[i];
    if (spanning.to_parent[t] != k_none) sums[twin[spanning.to_parent[t]] / 3].add(sums[t], 1);
  }
  pieces_.reserve(poles.size());
  for (const std::uint32_t t : poles) {
    pieces_.push_back({mesh.vertices()[highest_vertex(mesh.triangles()[t])], sums[t]});
  }

  potentials_.resize(sums.size());
  orders_.resize(sums.size());
  for (std::uint32_t i = 0; i < sums.size(); ++i) {
    const std::uint32_t t = tree.mesh_triangle()[i];
    const Triangle& v = mesh.triangles()[t];
    const auto lowest = static_cast<std::uint8_t>(std::min_element(v.begin(), v.end()) - v.begin());
    const bool rises = v[(lowest + 1u) % 3] < v[(lowest + 2u) % 3];
    orders_[i] = {static_cast<std::uint8_t>(lowest & 3u), rises};
    // The side from lowest to middle index: half-edge h, or its reverse if the middle corner comes last.
    const std::uint32_t h = 3 * t + (rises ? lowest : (lowest + 2u) % 3);
    const int sign = rises ? 1 : -1;
    if (spanning.to_parent[t] == h) {
      potentials_[i].add(sums[t], sign);
    } else if (spanning.to_parent[twin[h] / 3] == twin[h]) {
      potentials_[i].add(sums[twin[h] / 3], -sign);
    }
  }
}

std::vector<Solid::Potential> Solid::triangle_fluxes() {
  const std::vector<Triangle>& triangles = mesh_->triangles();
  const auto moments = [&](const Triangle& t) {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d { return mesh_->vertices()[t[k]] - tree_->center(); };
    return triangle_moments(corner(0), corner(1), corner(2));
  };
  double volume_sum = 0.0;
  double first_sum = 0.0;
  for (const Triangle& t : triangles) {
    const Moments m = moments(t);
    volume_sum += std::abs(m.volume);
    first_sum += m.first.lpNorm<1>();
  }
  volume_exponent_ = fixed_exponent(volume_sum);
  first_exponent_ = fixed_exponent(first_sum);
  std::vector<Potential> fluxes(triangles.size());
  for (std::size_t t = 0; t < fluxes.size(); ++t) {
    const Moments m = moments(triangles[t]);
    fluxes[t].volume = to_fixed(m.volume, volume_exponent_);
    for (std::size_t k = 0; k < 3; ++k) {
      fluxes[t].first[k] = to_fixed(m.first[static_cast<Eigen::Index>(k)], first_exponent_);
    }
  }
  return fluxes;
}

Solid::Moments Solid::to_moments(const Potential& sum) const {
  const auto first = [&](std::size_t k) { return std::ldexp(static_cast<double>(sum.first[k]), -first_exponent_); };
  return {std::ldexp(static_cast<double>(sum.volume), -volume_exponent_), {first(0), first(1), first(2)}};
}

std::size_t Solid::bytes() const {
  return potentials_.capacity() * sizeof(Potential) + orders_.capacity() * sizeof(Order) +
         pieces_.capacity() * sizeof(Piece);
}

}  // namespace sixdof
