#include <sixdof/models/refine.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include <Eigen/Geometry>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr std::uint32_t k_none = ~0U;

bool collapses_later(const Edge& x, const Edge& y) {
  return std::tie(x.length_squared, x.low, x.high) > std::tie(y.length_squared, y.low, y.high);
}

/// 1 for an equilateral triangle, 0 for a degenerate one: area over the sum of squared edges, scaled.
double quality(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d bc = c - b;
  const Eigen::Vector3d ca = a - c;
  const double edges = dot_in_order(ab, ab) + dot_in_order(bc, bc) + dot_in_order(ca, ca);
  return 2.0 * std::sqrt(3.0) * norm_in_order(ab.cross(ca)) / edges;
}

/// What the triangles changed by a collapse must fulfil; from strict to lax.
struct Limits {
  double quality;        ///< Least quality of a triangle, unless it is that low already.
  double cosine;         ///< Least cosine of the angle between a triangle's normals before and after.
  std::uint32_t degree;  ///< Most edges at the remaining vertex.
};
constexpr std::array<Limits, 3> k_limits{{{0.5, 0.7, 8}, {0.3, 0.5, 10}, {0.05, 0.3, 16}}};

class Coarsener {
  using Queue = std::priority_queue<Edge, std::vector<Edge>, decltype(&collapses_later)>;

 public:
  Coarsener(RawMesh& surface, const SurfaceProjection& project)
      : surface_(surface),
        project_(project),
        alive_(surface.triangles.size()),
        twin_(3 * surface.triangles.size(), k_none) {
    link_twins();
  }

  void collapse_until(std::size_t triangles) {
    for (const Limits& limits : k_limits) {
      if (alive_ <= triangles) return;
      fill_queue();
      while (alive_ > triangles && !queue_.empty()) {
        const Edge candidate = queue_.top();
        queue_.pop();
        if (is_current(candidate)) try_collapse(candidate.half_edge, limits);
      }
    }
    if (alive_ > triangles) throw BadMesh("the topology of the surface needs more triangles");
  }

  void smooth(int rounds) {
    std::vector<HalfEdge> first(surface_.vertices.size(), k_none);
    for (HalfEdge h = 0; h < twin_.size(); ++h) {
      if (is_alive(h)) first[origin(h)] = h;
    }
    for (int round = 0; round < rounds; ++round) {
      for (const HalfEdge h : first) {
        if (h != k_none) smooth_vertex(h);
      }
    }
  }

  /// Drops collapsed triangles and unused vertices; the order of the others stays.
  void compact() {
    std::erase_if(surface_.triangles, [](const Triangle& t) { return t[0] == k_none; });
    drop_unreferenced(surface_.vertices, surface_.triangles);
  }

 private:
  std::uint32_t& origin(HalfEdge h) { return surface_.triangles[h / 3][h % 3]; }
  std::uint32_t target(HalfEdge h) { return origin(next_corner(h)); }
  std::uint32_t opposite(HalfEdge h) { return origin(previous_corner(h)); }
  const Eigen::Vector3d& point(std::uint32_t v) const { return surface_.vertices[v]; }
  bool is_alive(HalfEdge h) { return surface_.triangles[h / 3][0] != k_none; }

  /// All half-edges that leave the same vertex, from `start` on.
  const std::vector<HalfEdge>& leaving(HalfEdge start) {
    around_.clear();
    HalfEdge h = start;
    do {
      around_.push_back(h);
      h = twin_[previous_corner(h)];
    } while (h != start);
    return around_;
  }

  void link_twins() {
    for_each_edge(sorted_sides(surface_.triangles), [this](std::span<const Side> sides) {
      if (sides.size() != 2 || sides[0].forward == sides[1].forward) {
        throw BadMesh("only closed, consistently oriented surfaces can be made coarser");
      }
      twin_[sides[0].corner] = sides[1].corner;
      twin_[sides[1].corner] = sides[0].corner;
    });
  }

  void fill_queue() {
    std::vector<Edge> edges;
    for (HalfEdge h = 0; h < twin_.size(); ++h) {
      if (is_alive(h) && h < twin_[h]) edges.push_back(edge_of(surface_, h));
    }
    queue_ = Queue(collapses_later, std::move(edges));
  }

  bool is_current(const Edge& c) {
    if (!is_alive(c.half_edge)) return false;
    const Edge now = edge_of(surface_, c.half_edge);
    return now.joins_same(c) && now.length_squared == c.length_squared;
  }

  /// Whether the triangles around the origin of `start`, but those at vertex `skip`, stay within the limits if that
  /// origin moves to `position`.
  bool keeps_limits(HalfEdge start, std::uint32_t skip, const Eigen::Vector3d& position, const Limits& limits) {
    const Eigen::Vector3d& old = point(origin(start));
    for (const HalfEdge h : leaving(start)) {
      const std::uint32_t b = target(h);
      const std::uint32_t c = opposite(h);
      if (b == skip || c == skip) continue;
      const Eigen::Vector3d before = (point(b) - old).cross(point(c) - old);
      const Eigen::Vector3d after = (point(b) - position).cross(point(c) - position);
      if (dot_in_order(before, after) <= limits.cosine * norm_in_order(before) * norm_in_order(after)) return false;
      if (quality(position, point(b), point(c)) < std::min(limits.quality, quality(old, point(b), point(c)))) {
        return false;
      }
    }
    return true;
  }

  std::vector<std::uint32_t> neighbours_of(HalfEdge start) {
    std::vector<std::uint32_t> result;
    for (const HalfEdge h : leaving(start)) result.push_back(target(h));
    return result;
  }

  bool keeps_topology(HalfEdge h, const Limits& limits) {
    const HalfEdge other = twin_[h];
    const std::vector<std::uint32_t> around_a = neighbours_of(h), around_b = neighbours_of(other);
    const std::size_t degree = around_a.size() + around_b.size() - 4;
    if (degree > limits.degree || degree < 3) return false;
    std::size_t common = 0;
    for (const std::uint32_t v : around_a) {
      common += static_cast<std::size_t>(std::count(around_b.begin(), around_b.end(), v));
    }
    return common == 2 && leaving(previous_corner(h)).size() > 3 && leaving(previous_corner(other)).size() > 3;
  }

  void try_collapse(HalfEdge h, const Limits& limits) {
    const HalfEdge other = twin_[h];
    const std::uint32_t a = origin(h);
    const std::uint32_t b = target(h);
    if (!keeps_topology(h, limits)) return;
    const Eigen::Vector3d position = project_(0.5 * (point(a) + point(b)));
    if (!keeps_limits(h, b, position, limits) || !keeps_limits(other, a, position, limits)) return;

    for (const HalfEdge g : leaving(other)) origin(g) = a;
    surface_.vertices[a] = position;
    HalfEdge leaving_a = k_none;
    for (const HalfEdge gone : {h, other}) {
      const HalfEdge left = twin_[next_corner(gone)];
      const HalfEdge right = twin_[previous_corner(gone)];
      twin_[left] = right;
      twin_[right] = left;
      if (gone == h) leaving_a = right;
    }
    for (const HalfEdge gone : {h, other}) surface_.triangles[gone / 3] = {k_none, k_none, k_none};
    alive_ -= 2;
    for (const HalfEdge g : leaving(leaving_a)) {
      queue_.push(edge_of(surface_, g));
      queue_.push(edge_of(surface_, next_corner(g)));
    }
  }

  /// Quality of the worst triangle at the origin of `start` if that origin moves to `position`.
  double worst_quality(HalfEdge start, const Eigen::Vector3d& position) {
    double worst = 1.0;
    for (const HalfEdge h : leaving(start)) {
      worst = std::min(worst, quality(position, point(target(h)), point(opposite(h))));
    }
    return worst;
  }

  /// Moves the origin of `start` to the mean of its neighbours if that improves its worst triangle.
  void smooth_vertex(HalfEdge start) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const HalfEdge h : leaving(start)) sum += point(target(h));
    const Eigen::Vector3d position = project_(sum / static_cast<double>(around_.size()));
    constexpr Limits k_any_quality{0.0, 0.7, 0};
    const Eigen::Vector3d& old = point(origin(start));
    if (worst_quality(start, position) > worst_quality(start, old) &&
        keeps_limits(start, k_none, position, k_any_quality)) {
      surface_.vertices[origin(start)] = position;
    }
  }

  RawMesh& surface_;
  const SurfaceProjection& project_;
  std::size_t alive_;
  std::vector<HalfEdge> twin_;
  Queue queue_;                   ///< Shortest first; may hold stale entries.
  std::vector<HalfEdge> around_;  ///< Of leaving().
};

}  // namespace

void coarsen_to(RawMesh& surface, std::size_t triangles, const SurfaceProjection& project) {
  constexpr int k_rounds = 8;  // of smoothing; more have little effect
  Coarsener coarsener(surface, project);
  coarsener.collapse_until(triangles);
  coarsener.smooth(k_rounds);
  coarsener.compact();
}

}  // namespace sixdof
