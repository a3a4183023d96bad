#include <sixdof/models/refine.h>

#include <queue>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

/// Order of splitting: a total order of the edges. "Less" is "later".
bool splits_later(const Edge& x, const Edge& y) {
  return std::tie(x.length_squared, y.low, y.high) < std::tie(y.length_squared, x.low, x.high);
}

class Refiner {
  using Queue = std::priority_queue<Edge, std::vector<Edge>, decltype(&splits_later)>;

 public:
  Refiner(RawMesh& surface, const SplitPosition& position) : surface_(surface), position_(position) {
    link_half_edges();
  }

  void split_longest() {
    while (true) {
      const Edge edge = queue_.top();
      queue_.pop();
      // The queue keeps entries of edges that have been split or belong to another half-edge now.
      if (!edge.joins_same(edge_of(surface_, edge.half_edge))) continue;
      split(edge);
      return;
    }
  }

 private:
  std::uint32_t& origin(HalfEdge h) { return surface_.triangles[h / 3][h % 3]; }

  /// Links the half-edges of each edge, of any number, in a ring, and keeps one queue entry per edge.
  void link_half_edges() {
    ring_.resize(3 * surface_.triangles.size());
    std::vector<Edge> edges;
    for_each_edge(sorted_sides(surface_.triangles), [&](std::span<const Side> sides) {
      for (std::size_t i = 0; i < sides.size(); ++i) ring_[sides[i].corner] = sides[(i + 1) % sides.size()].corner;
      edges.push_back(edge_of(surface_, sides[0].corner));
    });
    queue_ = Queue(splits_later, std::move(edges));
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
    queue_.push(edge_of(surface_, members.front()));
  }

  void split(const Edge& edge) {
    const std::uint32_t middle = surface_.add(position_(surface_, edge.low, edge.high));

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
      const HalfEdge after = next_corner(cut);
      const HalfEdge before = previous_corner(cut);
      const std::uint32_t a = origin(cut);
      const std::uint32_t b = origin(after);
      const std::uint32_t c = origin(before);
      const auto added = static_cast<HalfEdge>(3 * surface_.triangles.size());
      ring_.resize(ring_.size() + 3);
      replace_in_ring(after, added + 1);
      surface_.triangles.push_back({middle, b, c});
      origin(after) = middle;
      queue_.push(edge_of(surface_, added + 1));
      (a == edge.low ? at_low_ : at_high_).push_back(cut);
      (a == edge.low ? at_high_ : at_low_).push_back(added);
      ring_[after] = added + 2;
      ring_[added + 2] = after;
      queue_.push(edge_of(surface_, after));
    }
    link_ring(at_low_);
    link_ring(at_high_);
  }

  RawMesh& surface_;
  const SplitPosition& position_;
  Queue queue_;                 ///< Longest first; may hold stale entries.
  std::vector<HalfEdge> ring_;  ///< Next half-edge of the same edge.
  std::vector<HalfEdge> around_, at_low_, at_high_;
};

}  // namespace

Eigen::Vector3d midpoint_of_edge(const RawMesh& surface, std::uint32_t a, std::uint32_t b) {
  return 0.5 * (surface.vertices[a] + surface.vertices[b]);
}

void refine_to(RawMesh& surface, std::size_t triangles, const SplitPosition& position) {
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
  RawMesh surface{mesh.vertices(), mesh.triangles()};
  refine_to(surface, triangles);
  return to_mesh(std::move(surface), std::move(name));
}

}  // namespace sixdof
