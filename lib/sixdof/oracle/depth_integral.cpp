#include <sixdof/oracle/depth_integral.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/sides.h>
#include <sixdof/oracle/depth_piece.h>
#include <sixdof/oracle/signed_depth.h>
#include <sixdof/oracle/solid.h>

namespace sixdof {
namespace {

using detail::DepthNode;
using detail::DepthPiece;
using detail::DepthSums;
using detail::SignedDepth;

/// No piece that counts has a side longer than this times the diagonal of B's box: six nodes of a face of a box would
/// know little of the depths on it.
constexpr double k_longest_side = 1.0 / 16.0;
/// A round splits the pieces with the largest estimates, until the others' sum is this part of what is allowed; at most
/// k_share_of_round of the sum.
constexpr double k_left_by_round = 0.5;
constexpr double k_share_of_round = 0.75;

constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t k_children = 4;
constexpr std::size_t k_new_nodes = 9;  ///< By splitting a piece.

/// One evaluation.
class Quadrature {
 public:
  Quadrature(const DepthOracle& oracle, const Pose& X_AB, DepthDirection direction, const DepthTolerance& tolerance)
      : oracle_(oracle),
        X_AB_(X_AB),
        law_{direction, X_AB * oracle.b().center()},
        tolerance_(tolerance),
        lever_(DepthTolerance::k_lever * 0.5 * oracle.b().diagonal()),
        longest_side_(k_longest_side * oracle.b().diagonal()) {}

  DepthIntegral run() {
    start();
    sum_up();
    while (!result_.converged && pieces_.size() + k_children <= tolerance_.most_pieces) {
      if (!split(choose())) break;
      sum_up();
    }
    return result_;
  }

 private:
  /// body(i, SignedDepth&) for i in [0, n) by all threads.
  template <class Body>
  void for_each(std::size_t n, const Body& body) const {
    parallel::for_ranges(n, [&](std::size_t begin, std::size_t end) {
      SignedDepth depth(oracle_.a(), oracle_.tree_a());
      for (std::size_t i = begin; i < end; ++i) body(i, depth);
    });
  }

  Eigen::Vector3d corner(std::uint32_t triangle, std::size_t k) const {
    return X_AB_ * oracle_.b().vertices()[oracle_.b().triangles()[triangle][k]];
  }

  /// Twice the area vector of B's triangle, in A's frame.
  Eigen::Vector3d cross_of(std::uint32_t triangle) const {
    const Eigen::Vector3d a = corner(triangle, 0);
    return (corner(triangle, 1) - a).cross(corner(triangle, 2) - a);
  }

  /// Of a piece with a side that long.
  double longest_of(const std::array<std::uint32_t, 6>& node) const {
    const auto p = [&](std::size_t k) -> const Eigen::Vector3d& { return nodes_[node[k]].p; };
    return std::sqrt(std::max({(p(0) - p(1)).squaredNorm(), (p(1) - p(2)).squaredNorm(), (p(2) - p(0)).squaredNorm()}));
  }

  /// Needs its nodes, its triangle and `area`.
  void integrate(DepthPiece& piece, const Eigen::Vector3d& cross, double area) const {
    piece.longest = longest_of(piece.node);
    std::array<const DepthNode*, 6> nodes{};
    for (std::size_t k = 0; k < 6; ++k) nodes[k] = &nodes_[piece.node[k]];
    integrate_piece(piece, nodes, law_, area, cross.stableNormalized());
  }

  double area_of(const DepthPiece& piece) const {
    const auto p = [&](std::size_t k) -> const Eigen::Vector3d& { return nodes_[piece.node[k]].p; };
    return 0.5 * (p(1) - p(0)).cross(p(2) - p(0)).norm();
  }

  /// B's triangles in tree order that may have a point inside A, by the balls around B's volumes.
  std::vector<std::uint32_t> candidates() const {
    const Tree& tree = oracle_.tree_b();
    struct Volume {
      std::uint32_t node, child;
    };
    std::vector<Volume> level;
    const auto push = [&](std::uint32_t node) {
      for (std::uint32_t i = 0; i < tree.nodes()[node].child_count; ++i) level.push_back({node, i});
    };
    std::vector<std::uint32_t> found;
    push(0);
    while (!level.empty()) {
      std::vector<char> keep(level.size());
      for_each(level.size(), [&](std::size_t i, SignedDepth& depth) {
        const Tree::Node& node = tree.nodes()[level[i].node];
        const std::size_t c = level[i].child;
        const Eigen::Vector3d low(node.lower[0][c], node.lower[1][c], node.lower[2][c]);
        const Eigen::Vector3d high(node.upper[0][c], node.upper[1][c], node.upper[2][c]);
        const Eigen::Vector3d middle = tree.center() + 0.5 * (low + high);
        keep[i] = !depth.is_outside(X_AB_ * middle, 0.5 * (high - low).norm());
      });
      const std::vector<Volume> parents = std::exchange(level, {});
      for (std::size_t i = 0; i < parents.size(); ++i) {
        if (keep[i] == 0) continue;
        const Tree::Child child = tree.nodes()[parents[i].node].child[parents[i].child];
        if (!child.is_leaf()) {
          push(child.node());
          continue;
        }
        for (std::uint32_t t = child.first(); t < child.first() + child.count(); ++t) found.push_back(t);
      }
    }
    std::ranges::sort(found);
    for (std::uint32_t& t : found) t = tree.mesh_triangle()[t];
    return found;
  }

  /// Measures B's vertices of the triangles. @return node of each vertex
  std::vector<std::uint32_t> measure_vertices(const std::vector<std::uint32_t>& triangles) {
    std::vector<std::uint32_t> node_of(oracle_.b().vertices().size(), k_none), vertices;
    for (const std::uint32_t t : triangles) {
      for (const std::uint32_t v : oracle_.b().triangles()[t]) {
        if (node_of[v] != k_none) continue;
        node_of[v] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(v);
      }
    }
    nodes_.resize(vertices.size());
    parallel::for_ranges(vertices.size(), [&](std::size_t begin, std::size_t end) {
      SignedDepth depth(oracle_.a(), oracle_.tree_a());
      for (std::size_t i = begin; i < end; ++i) {
        const Eigen::Vector3d p = X_AB_ * oracle_.b().vertices()[vertices[i]];
        nodes_[i] = i > begin ? depth.at(p, nodes_[i - 1]) : depth.at(p, 0u);
      }
    });
    return node_of;
  }

  /// Makes a piece of each of B's triangles that may have a point inside A.
  void start() {
    const std::vector<std::uint32_t> triangles = candidates();
    const std::vector<std::uint32_t> node_of = measure_vertices(triangles);
    std::vector<std::uint32_t> node_of_edge(oracle_.edge_count(), k_none);
    std::vector<std::array<std::uint32_t, 2>> ends;
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    for (const std::uint32_t t : triangles) {
      DepthPiece piece{.triangle = t};
      for (std::size_t k = 0; k < 3; ++k) piece.node[k] = node_of[oracle_.b().triangles()[t][k]];
      const double reach = detail::k_reach_of_corners * longest_of(piece.node);
      const auto is_far = [&](std::size_t k) { return nodes_[piece.node[k]].s > reach; };
      if (is_far(0) && is_far(1) && is_far(2)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& edge = node_of_edge[oracle_.edge_of_b(t, k)];
        if (edge == k_none) {
          edge = first + static_cast<std::uint32_t>(ends.size());
          ends.push_back({piece.node[k], piece.node[(k + 1) % 3]});
        }
        piece.node[3 + k] = edge;
      }
      pieces_.push_back(piece);
    }
    nodes_.resize(first + ends.size());
    for_each(ends.size(), [&](std::size_t i, SignedDepth& depth) {
      nodes_[first + i] = middle(nodes_[ends[i][0]], nodes_[ends[i][1]], depth);
    });
    parallel::for_each(pieces_.size(), [&](std::size_t i) {
      const Eigen::Vector3d cross = cross_of(pieces_[i].triangle);
      integrate(pieces_[i], cross, 0.5 * cross.norm());
    });
    std::erase_if(pieces_, [](const DepthPiece& piece) { return piece.outside; });
    result_.searches = nodes_.size();
  }

  static DepthNode middle(const DepthNode& a, const DepthNode& b, SignedDepth& depth) {
    // The farther from the surface, the sooner it says on which side the middle is.
    const DepthNode& known = std::abs(a.s) >= std::abs(b.s) ? a : b;
    return depth.at(0.5 * (a.p + b.p), known);
  }

  /// Errors over what is allowed, together.
  double priority(const DepthPiece& piece) const {
    if (piece.longest > longest_side_) return std::numeric_limits<double>::infinity();
    return piece.force_error * per_force_ + piece.torque_error * per_torque_;
  }

  /// The pieces of the next round, in the order of their places.
  std::vector<std::uint32_t> choose() const {
    std::vector<std::uint32_t> order(pieces_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<double> priorities(pieces_.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      priorities[i] = priority(pieces_[i]);
      if (std::isfinite(priorities[i])) sum += priorities[i];
    }
    std::ranges::sort(order, [&](std::uint32_t i, std::uint32_t j) {
      return priorities[i] != priorities[j] ? priorities[i] > priorities[j] : i < j;
    });
    const double wanted = std::min(k_share_of_round * sum, sum - left_by_round_);
    const std::size_t most = (tolerance_.most_pieces - pieces_.size()) / (k_children - 1);
    std::size_t count = 0;
    for (double taken = 0.0; count < std::min(most, order.size()); ++count) {
      const double next = priorities[order[count]];
      if (std::isfinite(next) && !(taken < wanted && next > 0.0)) break;
      if (std::isfinite(next)) taken += next;
    }
    order.resize(count);
    std::ranges::sort(order);
    return order;
  }

  /// Replaces pieces by their quarters. @return whether there were any
  bool split(const std::vector<std::uint32_t>& chosen) {
    if (chosen.empty()) return false;
    const std::size_t first_node = nodes_.size(), first_piece = pieces_.size();
    nodes_.resize(first_node + k_new_nodes * chosen.size());
    pieces_.resize(first_piece + (k_children - 1) * chosen.size());
    for_each(chosen.size(), [&](std::size_t i, SignedDepth& depth) {
      const std::array<DepthPiece, k_children> parts =
          quarters_of(pieces_[chosen[i]], static_cast<std::uint32_t>(first_node + k_new_nodes * i), depth);
      pieces_[chosen[i]] = parts[0];
      for (std::size_t k = 1; k < k_children; ++k) pieces_[first_piece + (k_children - 1) * i + k - 1] = parts[k];
    });
    std::erase_if(pieces_, [](const DepthPiece& piece) { return piece.outside; });
    result_.searches = nodes_.size();
    return true;
  }

  /// @param at place of the first new node
  std::array<DepthPiece, k_children> quarters_of(const DepthPiece& piece, std::uint32_t at, SignedDepth& depth) {
    const auto& n = piece.node;
    // Midpoints of the halves of sides 01, 12, 20, then of the inner sides 35, 34, 45.
    const std::array<std::array<std::uint32_t, 2>, k_new_nodes> ends{{{n[0], n[3]},
                                                                      {n[3], n[1]},
                                                                      {n[1], n[4]},
                                                                      {n[4], n[2]},
                                                                      {n[2], n[5]},
                                                                      {n[5], n[0]},
                                                                      {n[3], n[5]},
                                                                      {n[3], n[4]},
                                                                      {n[4], n[5]}}};
    for (std::uint32_t k = 0; k < k_new_nodes; ++k)
      nodes_[at + k] = middle(nodes_[ends[k][0]], nodes_[ends[k][1]], depth);
    const std::array<std::array<std::uint32_t, 6>, k_children> node{{{n[0], n[3], n[5], at, at + 6, at + 5},
                                                                     {n[3], n[1], n[4], at + 1, at + 2, at + 7},
                                                                     {n[5], n[4], n[2], at + 8, at + 3, at + 4},
                                                                     {n[3], n[4], n[5], at + 7, at + 8, at + 6}}};
    const Eigen::Vector3d cross = cross_of(piece.triangle);
    const double area = area_of(piece) / k_children;
    std::array<DepthPiece, k_children> parts;
    for (std::size_t k = 0; k < k_children; ++k) {
      parts[k] = {.node = node[k], .triangle = piece.triangle};
      integrate(parts[k], cross, area);
    }
    return parts;
  }

  void sum_up() {
    DepthSums sums;
    double force_error = 0.0, torque_error = 0.0;
    bool coarse = false;
    for (const DepthPiece& piece : pieces_) {
      sums += piece.sums;
      force_error += piece.force_error;
      torque_error += piece.torque_error;
      coarse = coarse || piece.longest > longest_side_;
    }
    result_.force = sums.force;
    result_.torque = sums.torque;
    result_.reference = law_.reference;
    result_.area = sums.area;
    result_.depth_integral = sums.depth;
    result_.force_error = force_error;
    result_.torque_error = torque_error;
    result_.pieces = pieces_.size();
    double deepest = 0.0;
    for (const DepthNode& node : nodes_) deepest = std::min(deepest, node.s);
    result_.depth = -deepest;
    const double diagonal = oracle_.b().diagonal();
    const double force = std::max({sums.force.norm(), DepthTolerance::k_cancelled * sums.depth,
                                   DepthTolerance::k_least * diagonal * diagonal * diagonal});
    const double force_allowed = tolerance_.relative * force;
    const double torque_allowed = tolerance_.relative * std::max(sums.torque.norm(), lever_ * force);
    per_force_ = force_allowed > 0.0 ? 1.0 / force_allowed : 1.0;
    per_torque_ = torque_allowed > 0.0 ? 1.0 / torque_allowed : 1.0;
    left_by_round_ = force_allowed > 0.0 ? k_left_by_round : 0.0;
    result_.converged = !coarse && force_error <= force_allowed && torque_error <= torque_allowed;
  }

  const DepthOracle& oracle_;
  const Pose& X_AB_;
  const detail::DepthLaw law_;
  const DepthTolerance& tolerance_;
  const double lever_;         ///< Of torques that are as important as the force.
  const double longest_side_;  ///< Of a piece.
  std::vector<DepthNode> nodes_;
  std::vector<DepthPiece> pieces_;
  double per_force_ = 1.0, per_torque_ = 1.0;  ///< 1 / what is allowed; 1 where nothing is.
  double left_by_round_ = 0.0;
  DepthIntegral result_;
};

void require_solid(const Mesh& mesh) {
  if (!mesh.solid()) throw BadMesh(mesh.name() + ": " + mesh.why_not_solid() + k_repair_hint);
}

}  // namespace

DepthOracle::DepthOracle(const Mesh& a, const Mesh& b)
    : a_((require_solid(a), &a)),
      b_((require_solid(b), &b)),
      tree_a_(a),
      tree_b_(b),
      edges_b_(3 * b.triangles().size()) {
  const std::vector<Side> sides = sorted_sides(b.triangles());
  for_each_edge(sides, [&](std::span<const Side> edge) {
    for (const Side& side : edge) edges_b_[side.corner] = static_cast<std::uint32_t>(edge_count_);
    ++edge_count_;
  });
}

DepthIntegral DepthOracle::evaluate(const Pose& X_AB, DepthDirection direction, const DepthTolerance& tolerance) const {
  return Quadrature(*this, X_AB, direction, tolerance).run();
}

std::size_t DepthOracle::bytes() const {
  return tree_a_.bytes() + tree_b_.bytes() + edges_b_.capacity() * sizeof(std::uint32_t);
}

}  // namespace sixdof
