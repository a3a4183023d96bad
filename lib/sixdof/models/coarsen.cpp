#include <sixdof/models/coarsen.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include <sixdof/base/error.h>
#include <sixdof/models/fixed_order.h>

namespace sixdof {
namespace {

using HalfEdge = std::uint32_t;  // 3 * triangle + corner: from that corner to the next
constexpr std::uint32_t k_none = ~0U;

HalfEdge next_of(HalfEdge h) { return h % 3 == 2 ? h - 2 : h + 1; }
HalfEdge previous_of(HalfEdge h) { return h % 3 == 0 ? h + 2 : h - 1; }

struct Candidate {
  double length_squared;
  std::uint32_t low, high;
  HalfEdge half_edge;
};

bool collapses_later(const Candidate& x, const Candidate& y) {
  if (x.length_squared != y.length_squared) return x.length_squared > y.length_squared;
  if (x.low != y.low) return x.low > y.low;
  return x.high > y.high;
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
 public:
  Coarsener(Surface& surface, const Project& project)
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
        std::pop_heap(queue_.begin(), queue_.end(), collapses_later);
        const Candidate candidate = queue_.back();
        queue_.pop_back();
        if (is_current(candidate)) try_collapse(candidate.half_edge, limits);
      }
    }
    if (alive_ > triangles) throw BadMesh("the topology of the surface needs more triangles");
  }

  void smooth(int rounds) {
    std::vector<HalfEdge> leaving(surface_.vertices.size(), k_none);
    for (HalfEdge h = 0; h < twin_.size(); ++h) {
      if (is_alive(h)) leaving[origin(h)] = h;
    }
    for (int round = 0; round < rounds; ++round) {
      for (const HalfEdge h : leaving) {
        if (h != k_none) smooth_vertex(h);
      }
    }
  }

  /// Drops collapsed triangles and unused vertices; the order of the others stays.
  void compact() {
    Surface kept;
    std::vector<std::uint32_t> number(surface_.vertices.size(), k_none);
    for (HalfEdge h = 0; h < twin_.size(); ++h) {
      if (is_alive(h)) number[origin(h)] = 0;
    }
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] == k_none) continue;
      number[v] = static_cast<std::uint32_t>(kept.vertices.size());
      kept.vertices.push_back(surface_.vertices[v]);
    }
    for (const Triangle& t : surface_.triangles) {
      if (t[0] != k_none) kept.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
    }
    surface_ = std::move(kept);
  }

 private:
  std::uint32_t& origin(HalfEdge h) { return surface_.triangles[h / 3][h % 3]; }
  std::uint32_t target(HalfEdge h) { return origin(next_of(h)); }
  std::uint32_t opposite(HalfEdge h) { return origin(previous_of(h)); }
  const Eigen::Vector3d& point(std::uint32_t v) const { return surface_.vertices[v]; }
  bool is_alive(HalfEdge h) { return surface_.triangles[h / 3][0] != k_none; }
  /// The next half-edge that leaves the same vertex.
  HalfEdge next_around_origin(HalfEdge h) const { return twin_[previous_of(h)]; }

  void link_twins() {
    std::vector<Candidate> edges;
    for (HalfEdge h = 0; h < twin_.size(); ++h) edges.push_back(candidate_of(h));
    std::sort(edges.begin(), edges.end(), [](const Candidate& x, const Candidate& y) {
      if (x.low != y.low) return x.low < y.low;
      if (x.high != y.high) return x.high < y.high;
      return x.half_edge < y.half_edge;
    });
    for (std::size_t i = 0; i < edges.size(); i += 2) {
      if (i + 1 == edges.size() || edges[i].low != edges[i + 1].low || edges[i].high != edges[i + 1].high ||
          origin(edges[i].half_edge) == origin(edges[i + 1].half_edge)) {
        throw BadMesh("only closed, consistently oriented surfaces can be made coarser");
      }
      twin_[edges[i].half_edge] = edges[i + 1].half_edge;
      twin_[edges[i + 1].half_edge] = edges[i].half_edge;
    }
  }

  Candidate candidate_of(HalfEdge h) {
    const std::uint32_t a = origin(h);
    const std::uint32_t b = target(h);
    const std::uint32_t low = std::min(a, b);
    const std::uint32_t high = std::max(a, b);
    const Eigen::Vector3d along = point(high) - point(low);
    return {dot_in_order(along, along), low, high, h};
  }

  void fill_queue() {
    queue_.clear();
    for (HalfEdge h = 0; h < twin_.size(); ++h) {
      if (is_alive(h) && h < twin_[h]) queue_.push_back(candidate_of(h));
    }
    std::make_heap(queue_.begin(), queue_.end(), collapses_later);
  }

  bool is_current(const Candidate& c) {
    if (!is_alive(c.half_edge)) return false;
    const Candidate now = candidate_of(c.half_edge);
    return now.low == c.low && now.high == c.high && now.length_squared == c.length_squared;
  }

  /// Whether the triangles around the origin of `start`, but those at vertex `skip`, stay within the limits if that
  /// origin moves to `position`.
  bool keeps_limits(HalfEdge start, std::uint32_t skip, const Eigen::Vector3d& position, const Limits& limits) {
    HalfEdge h = start;
    do {
      const std::uint32_t b = target(h);
      const std::uint32_t c = opposite(h);
      if (b != skip && c != skip) {
        const Eigen::Vector3d before = (point(b) - point(origin(h))).cross(point(c) - point(origin(h)));
        const Eigen::Vector3d after = (point(b) - position).cross(point(c) - position);
        if (dot_in_order(before, after) <= limits.cosine * norm_in_order(before) * norm_in_order(after)) return false;
        if (quality(position, point(b), point(c)) <
            std::min(limits.quality, quality(point(origin(h)), point(b), point(c)))) {
          return false;
        }
      }
      h = next_around_origin(h);
    } while (h != start);
    return true;
  }

  void neighbours_of(HalfEdge start, std::vector<std::uint32_t>& out) {
    out.clear();
    HalfEdge h = start;
    do {
      out.push_back(target(h));
      h = next_around_origin(h);
    } while (h != start);
  }

  std::uint32_t degree(HalfEdge start) const {
    std::uint32_t count = 0;
    HalfEdge h = start;
    do {
      ++count;
      h = next_around_origin(h);
    } while (h != start);
    return count;
  }

  bool keeps_topology(HalfEdge h, const Limits& limits) {
    const HalfEdge other = twin_[h];
    neighbours_of(h, around_a_);
    neighbours_of(other, around_b_);
    if (around_a_.size() + around_b_.size() - 4 > limits.degree || around_a_.size() + around_b_.size() < 7)
      return false;
    std::size_t common = 0;
    for (const std::uint32_t v : around_a_) {
      common += static_cast<std::size_t>(std::count(around_b_.begin(), around_b_.end(), v));
    }
    return common == 2 && degree(previous_of(h)) > 3 && degree(previous_of(other)) > 3;
  }

  void try_collapse(HalfEdge h, const Limits& limits) {
    const HalfEdge other = twin_[h];
    const std::uint32_t a = origin(h);
    const std::uint32_t b = target(h);
    if (!keeps_topology(h, limits)) return;
    const Eigen::Vector3d position = project_(0.5 * (point(a) + point(b)));
    if (!keeps_limits(h, b, position, limits) || !keeps_limits(other, a, position, limits)) return;

    HalfEdge g = other;
    do {
      origin(g) = a;
      g = next_around_origin(g);
    } while (g != other);
    surface_.vertices[a] = position;
    HalfEdge leaving_a = k_none;
    for (const HalfEdge gone : {h, other}) {
      const HalfEdge left = twin_[next_of(gone)];
      const HalfEdge right = twin_[previous_of(gone)];
      twin_[left] = right;
      twin_[right] = left;
      if (gone == h) leaving_a = right;
    }
    for (const HalfEdge gone : {h, other}) surface_.triangles[gone / 3] = {k_none, k_none, k_none};
    alive_ -= 2;
    g = leaving_a;
    do {
      push(g);
      push(next_of(g));
      g = next_around_origin(g);
    } while (g != leaving_a);
  }

  void push(HalfEdge h) {
    queue_.push_back(candidate_of(h));
    std::push_heap(queue_.begin(), queue_.end(), collapses_later);
  }

  /// Quality of the worst triangle at the origin of `start` if that origin moves to `position`.
  double worst_quality(HalfEdge start, const Eigen::Vector3d& position) {
    double worst = 1.0;
    HalfEdge h = start;
    do {
      worst = std::min(worst, quality(position, point(target(h)), point(opposite(h))));
      h = next_around_origin(h);
    } while (h != start);
    return worst;
  }

  /// Moves the origin of `start` to the mean of its neighbours if that improves its worst triangle.
  void smooth_vertex(HalfEdge start) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0.0;
    HalfEdge h = start;
    do {
      sum += point(target(h));
      count += 1.0;
      h = next_around_origin(h);
    } while (h != start);
    const Eigen::Vector3d position = project_(sum / count);
    constexpr Limits k_any_quality{0.0, 0.7, 0};
    const Eigen::Vector3d& old = point(origin(start));
    if (worst_quality(start, position) > worst_quality(start, old) &&
        keeps_limits(start, k_none, position, k_any_quality)) {
      surface_.vertices[origin(start)] = position;
    }
  }

  Surface& surface_;
  const Project& project_;
  std::size_t alive_;
  std::vector<HalfEdge> twin_;
  std::vector<Candidate> queue_;  ///< Heap, shortest first; may hold stale entries.
  std::vector<std::uint32_t> around_a_, around_b_;
};

}  // namespace

void coarsen_to(Surface& surface, std::size_t triangles, const Project& project) {
  constexpr int k_rounds = 8;  // of smoothing; more have little effect
  Coarsener coarsener(surface, project);
  coarsener.collapse_until(triangles);
  coarsener.smooth(k_rounds);
  coarsener.compact();
}

}  // namespace sixdof
