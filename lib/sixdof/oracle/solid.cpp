#include <sixdof/oracle/solid.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/predicates.h>

namespace sixdof {
namespace {

constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();

/// Bits of a potential of the size of all fluxes together; the rest of the 127 is room for curves that pass an edge
/// many times.
constexpr int k_potential_bits = 96;

void check(const Mesh& mesh) {
  if (!mesh.solid()) throw BadMesh(fmt::format("{}: {}", mesh.name(), mesh.why_not_solid()));
  for (std::size_t i = 0; i < mesh.vertices().size(); ++i) {
    for (const double x : mesh.vertices()[i]) {
      if (x != 0.0 && (std::abs(x) < k_smallest_exact_coordinate || std::abs(x) > k_largest_exact_coordinate)) {
        throw BadMesh(
            fmt::format("{}: vertex {}: coordinate {} is outside the range of exact predicates", mesh.name(), i, x));
      }
    }
  }
}

/// For each half-edge 3 t + k (corner k to the next) the half-edge that runs back along it. Edges with more than two
/// triangles are paired in order: any pairing of opposite directions makes a closed surface.
std::vector<std::uint32_t> pair_half_edges(const Mesh& mesh) {
  const std::vector<Triangle>& triangles = mesh.triangles();
  struct HalfEdge {
    std::uint32_t high, index;
  };
  // Buckets by lower vertex, each sorted by the higher one.
  std::vector<std::uint32_t> begin(mesh.vertices().size() + 1, 0);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++begin[std::min(t[k], t[(k + 1) % 3]) + 1];
  }
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<HalfEdge> edges(3 * triangles.size());
  std::vector<std::uint32_t> fill(begin.begin(), begin.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      edges[fill[std::min(from, to)]++] = {std::max(from, to), 3 * t + k};
    }
  }
  std::vector<std::uint32_t> twin(edges.size(), k_none);
  const auto rises = [&](std::uint32_t h) { return triangles[h / 3][h % 3] < triangles[h / 3][(h % 3 + 1) % 3]; };
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    const auto first = edges.begin() + begin[v];
    const auto last = edges.begin() + begin[v + 1];
    std::sort(first, last, [](const HalfEdge& a, const HalfEdge& b) {
      return a.high != b.high ? a.high < b.high : a.index < b.index;
    });
    for (auto i = first; i != last; ++i) {
      if (twin[i->index] != k_none) continue;
      for (auto j = i + 1; j != last && j->high == i->high; ++j) {
        if (twin[j->index] == k_none && rises(j->index) != rises(i->index)) {
          twin[i->index] = j->index;
          twin[j->index] = i->index;
          break;
        }
      }
    }
  }
  return twin;
}

std::uint32_t highest_vertex(const Triangle& t) { return std::max({t[0], t[1], t[2]}); }

Solid::Integer to_fixed(double x, int exponent) { return static_cast<Solid::Integer>(std::ldexp(x, exponent)); }

/// Exponent e such that total * 2^e just needs k_potential_bits.
int fixed_exponent(double total) {
  int exponent = 0;
  std::frexp(total, &exponent);
  return k_potential_bits - exponent;
}

}  // namespace

Solid::Solid(const Mesh& mesh, const Tree& tree) : mesh_(&mesh), tree_(&tree) {
  check(mesh);
  const std::vector<Triangle>& triangles = mesh.triangles();
  const std::size_t n = triangles.size();
  const auto moments = [&](std::uint32_t t) {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
      return mesh.vertices()[triangles[t][k]] - tree.center();
    };
    return triangle_moments(corner(0), corner(1), corner(2));
  };
  double volume_sum = 0.0;
  double first_sum = 0.0;
  for (std::uint32_t t = 0; t < n; ++t) {
    const Moments m = moments(t);
    volume_sum += std::abs(m.volume);
    first_sum += m.first.lpNorm<1>();
  }
  volume_exponent_ = fixed_exponent(volume_sum);
  first_exponent_ = fixed_exponent(first_sum);

  // Poles: far from the centre, so that most often they lie outside the other body's box and no ray is needed.
  std::vector<std::uint32_t> piece_of(n, k_none);
  const std::vector<std::uint32_t> twin = pair_half_edges(mesh);
  std::vector<std::uint32_t> queue;
  queue.reserve(n);
  std::vector<std::uint32_t> roots;
  const auto flood = [&](std::uint32_t root, auto&& enter) {
    const std::size_t first = queue.size();
    queue.push_back(root);
    for (std::size_t i = first; i < queue.size(); ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t back = twin[3 * queue[i] + k];
        if (enter(back)) queue.push_back(back / 3);
      }
    }
    return first;
  };
  for (std::uint32_t t = 0; t < n; ++t) {
    if (piece_of[t] != k_none) continue;
    const auto number = static_cast<std::uint32_t>(roots.size());
    piece_of[t] = number;
    const std::size_t first = flood(t, [&](std::uint32_t back) {
      if (piece_of[back / 3] != k_none) return false;
      piece_of[back / 3] = number;
      return true;
    });
    const auto distance = [&](std::uint32_t triangle) {
      return (mesh.vertices()[highest_vertex(triangles[triangle])] - tree.center()).squaredNorm();
    };
    roots.push_back(*std::max_element(queue.begin() + static_cast<std::ptrdiff_t>(first), queue.end(),
                                      [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); }));
  }

  // Fluxes sum from the leaves of a spanning tree of the triangles to its root, the pole; the sum at each triangle is
  // the potential of the edge to its parent. Edges outside the spanning tree have potential 0.
  const auto add = [](Potential& sum, const Potential& x) {
    sum.volume += x.volume;
    for (std::size_t k = 0; k < 3; ++k) sum.first[k] += x.first[k];
  };
  std::vector<Potential> sums(n);
  for (std::uint32_t t = 0; t < n; ++t) {
    const Moments m = moments(t);
    sums[t].volume = to_fixed(m.volume, volume_exponent_);
    for (std::size_t k = 0; k < 3; ++k) {
      sums[t].first[k] = to_fixed(m.first[static_cast<Eigen::Index>(k)], first_exponent_);
    }
  }
  std::vector<std::uint32_t> to_parent(n, k_none);  // half-edge of the child
  queue.clear();
  for (const std::uint32_t root : roots) {
    flood(root, [&, root](std::uint32_t back) {
      const std::uint32_t t = back / 3;
      if (t == root || to_parent[t] != k_none) return false;
      to_parent[t] = back;
      return true;
    });
  }
  for (std::size_t i = n; i-- > 0;) {
    const std::uint32_t t = queue[i];
    if (to_parent[t] != k_none) add(sums[twin[to_parent[t]] / 3], sums[t]);
  }
  pieces_.resize(roots.size());
  for (std::size_t i = 0; i < roots.size(); ++i) {
    pieces_[i].pole = mesh.vertices()[highest_vertex(triangles[roots[i]])];
    pieces_[i].total = sums[roots[i]];
  }

  potentials_.resize(n);
  orders_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t t = tree.mesh_triangle()[i];
    const Triangle& v = triangles[t];
    const auto lowest = static_cast<std::uint8_t>(std::min_element(v.begin(), v.end()) - v.begin());
    const bool rises = v[(lowest + 1u) % 3] < v[(lowest + 2u) % 3];
    orders_[i] = {lowest, rises};
    // The rising side leaves the lowest corner, or, run through backwards, arrives there.
    const std::uint32_t h = 3 * t + (rises ? lowest : (lowest + 2u) % 3);
    Potential p;
    if (to_parent[t] == h) {
      p = sums[t];
    } else if (to_parent[twin[h] / 3] == twin[h]) {
      const Potential& s = sums[twin[h] / 3];
      p = {-s.volume, {-s.first[0], -s.first[1], -s.first[2]}};
    }
    if (!rises) p = {-p.volume, {-p.first[0], -p.first[1], -p.first[2]}};
    potentials_[i] = p;
  }
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
