#include <sixdof/models/refine.h>

#include <algorithm>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/models/fixed_order.h>

namespace sixdof {
namespace {

using HalfEdge = std::uint32_t;  // 3 * triangle + corner: from that corner to the next

HalfEdge next_in_triangle(HalfEdge h) { return h % 3 == 2 ? h - 2 : h + 1; }
HalfEdge previous_in_triangle(HalfEdge h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// An edge by its end points, low < high, and one of its half-edges.
struct Edge {
  double length_squared;
  std::uint32_t low, high;
  HalfEdge half_edge;

  bool joins_same(const Edge& other) const { return low == other.low && high == other.high; }
};

/// Order of splitting: a total order of the edges. "Less" is "later".
bool splits_later(const Edge& x, const Edge& y) {
  if (x.length_squared != y.length_squared) return x.length_squared < y.length_squared;
  if (x.low != y.low) return x.low > y.low;
  return x.high > y.high;
}

class Refiner {
 public:
  Refiner(Surface& surface, const SplitPosition& position) : surface_(surface), position_(position) {
    const std::size_t half_edges = 3 * surface.triangles.size();
    queue_.reserve(half_edges);
    for (std::size_t h = 0; h < half_edges; ++h) queue_.push_back(edge_of(static_cast<HalfEdge>(h)));
    link_half_edges();
    std::make_heap(queue_.begin(), queue_.end(), splits_later);
  }

  void split_longest() {
    while (true) {
      std::pop_heap(queue_.begin(), queue_.end(), splits_later);
      const Edge edge = queue_.back();
      queue_.pop_back();
      // The queue keeps entries of edges that have been split or belong to another half-edge now.
      if (!edge.joins_same(edge_of(edge.half_edge))) continue;
      split(edge);
      return;
    }
  }

 private:
  std::uint32_t& origin(HalfEdge h) { return surface_.triangles[h / 3][h % 3]; }

  Edge edge_of(HalfEdge h) {
    const std::uint32_t a = origin(h);
    const std::uint32_t b = origin(next_in_triangle(h));
    // From the lower number to the higher: the length has the same bits on both sides.
    const auto [low, high] = std::minmax(a, b);
    const Eigen::Vector3d along = surface_.vertices[high] - surface_.vertices[low];
    return {dot_in_order(along, along), low, high, h};
  }

  /// Links the half-edges of each edge, of any number, in a ring, and keeps one queue entry per edge.
  void link_half_edges() {
    std::sort(queue_.begin(), queue_.end(), [](const Edge& x, const Edge& y) {
      if (x.low != y.low) return x.low < y.low;
      if (x.high != y.high) return x.high < y.high;
      return x.half_edge < y.half_edge;
    });
    ring_.resize(queue_.size());
    std::size_t kept = 0;
    for (std::size_t first = 0; first < queue_.size();) {
      std::size_t last = first;
      while (last + 1 < queue_.size() && queue_[last + 1].joins_same(queue_[first])) {
        ring_[queue_[last].half_edge] = queue_[last + 1].half_edge;
        ++last;
      }
      ring_[queue_[last].half_edge] = queue_[first].half_edge;
      queue_[kept++] = queue_[first];
      first = last + 1;
    }
    queue_.resize(kept);
  }

  /// Replaces `old` by `fresh` in its ring.
  void replace_in_ring(HalfEdge old, HalfEdge fresh) {
    if (ring_[old] == old) {
      ring_[fresh] = fresh;
      return;
    }
    HalfEdge before = old;
    while (ring_[before] != old) before = ring_[before];
    ring_[fresh] = ring_[old];
    ring_[before] = fresh;
  }

  void link_ring(const std::vector<HalfEdge>& members) {
    for (std::size_t i = 0; i < members.size(); ++i) ring_[members[i]] = members[(i + 1) % members.size()];
    push(members.front());
  }

  void push(HalfEdge h) {
    queue_.push_back(edge_of(h));
    std::push_heap(queue_.begin(), queue_.end(), splits_later);
  }

  void split(const Edge& edge) {
    const auto middle = static_cast<std::uint32_t>(surface_.vertices.size());
    surface_.vertices.push_back(position_(surface_, edge.low, edge.high));

    around_.clear();
    HalfEdge h = edge.half_edge;
    do {
      around_.push_back(h);
      h = ring_[h];
    } while (h != edge.half_edge);

    at_low_.clear();
    at_high_.clear();
    for (const HalfEdge cut : around_) {
      // Triangle (a, b, c), split on a-b, becomes (a, middle, c); triangle (middle, b, c) is added.
      const HalfEdge after = next_in_triangle(cut);
      const HalfEdge before = previous_in_triangle(cut);
      const std::uint32_t a = origin(cut);
      const std::uint32_t b = origin(after);
      const std::uint32_t c = origin(before);
      const auto added = static_cast<HalfEdge>(3 * surface_.triangles.size());
      ring_.resize(ring_.size() + 3);
      replace_in_ring(after, added + 1);
      surface_.triangles.push_back({middle, b, c});
      origin(after) = middle;
      push(added + 1);
      (a == edge.low ? at_low_ : at_high_).push_back(cut);
      (a == edge.low ? at_high_ : at_low_).push_back(added);
      ring_[after] = added + 2;
      ring_[added + 2] = after;
      push(after);
    }
    link_ring(at_low_);
    link_ring(at_high_);
  }

  Surface& surface_;
  const SplitPosition& position_;
  std::vector<Edge> queue_;     ///< Heap, longest first; may hold stale entries.
  std::vector<HalfEdge> ring_;  ///< Next half-edge of the same edge.
  std::vector<HalfEdge> around_, at_low_, at_high_;
};

}  // namespace

Eigen::Vector3d midpoint_of_edge(const Surface& surface, std::uint32_t a, std::uint32_t b) {
  return 0.5 * (surface.vertices[a] + surface.vertices[b]);
}

void refine_to(Surface& surface, std::size_t triangles, const SplitPosition& position) {
  if (surface.triangles.size() >= triangles) return;
  surface.triangles.reserve(triangles + 2);
  Refiner refiner(surface, position);
  while (surface.triangles.size() < triangles) refiner.split_longest();
}

Mesh subdivide(const Mesh& mesh, std::size_t triangles, std::string name) {
  if (triangles > k_maximum_triangles) {
    throw BadArgument(
        fmt::format("{}: at most {} triangles can be made; {} were asked for", name, k_maximum_triangles, triangles));
  }
  Surface surface{mesh.vertices(), mesh.triangles()};
  refine_to(surface, triangles);
  return to_mesh(std::move(surface), std::move(name));
}

}  // namespace sixdof
