#include <sixdof/repair/steps.h>

#include <algorithm>
#include <array>
#include <tuple>

namespace sixdof::repairing {
namespace {

/// A triangle's corners in ascending order, and whether an odd permutation gives them.
struct Key {
  Triangle corners;
  bool odd;
  std::uint32_t triangle;

  bool operator<(const Key& other) const {
    return std::tie(corners, triangle) < std::tie(other.corners, other.triangle);
  }
};

std::vector<Key> sorted_keys(const std::vector<Triangle>& triangles) {
  std::vector<Key> keys;
  keys.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    Key key{triangles[i], false, i};
    const auto order = [&](std::size_t a, std::size_t b) {
      if (key.corners[a] <= key.corners[b]) return;
      std::swap(key.corners[a], key.corners[b]);
      key.odd = !key.odd;
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// 1 for each triangle with an edge of an odd number of triangles.
std::vector<std::uint8_t> at_odd_edges(const std::vector<Triangle>& triangles) {
  std::vector<std::uint8_t> odd(triangles.size(), 0);
  for_each_edge(sorted_sides(triangles), [&](std::span<const Side> edge) {
    if (edge.size() % 2 == 0) return;
    for (const Side& side : edge) odd[side.triangle()] = 1;
  });
  return odd;
}

/// Drops those triangles of a group with equal corners for which drop(first, other) is true.
template <class Drop>
std::size_t drop_from_groups(RawMesh& surface, RepairLog& log, const Drop& drop) {
  const std::vector<Key> keys = sorted_keys(surface.triangles);
  std::vector<std::uint8_t> marked(surface.triangles.size(), 0);
  std::size_t dropped = 0;
  for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
    for (end = begin + 1; end < keys.size() && keys[end].corners == keys[begin].corners; ++end) {
      const auto first = std::find_if(keys.begin() + static_cast<std::ptrdiff_t>(begin),
                                      keys.begin() + static_cast<std::ptrdiff_t>(end),
                                      [&](const Key& key) { return drop(key, keys[end]); });
      if (first == keys.begin() + static_cast<std::ptrdiff_t>(end)) continue;
      marked[keys[end].triangle] = 1;
      ++dropped;
      log.add(RepairKind::duplicate_triangles, surface.middle(surface.triangles[keys[end].triangle]));
    }
  }
  if (dropped > 0) erase_marked(surface.triangles, marked);
  return dropped;
}

/// Corner at the start of the longest side.
std::size_t longest_side_of(const RawMesh& surface, const Triangle& t) {
  const auto squared = [&](std::size_t k) {
    return (surface.vertices[t[k]] - surface.vertices[t[(k + 1) % 3]]).squaredNorm();
  };
  const std::array lengths{squared(0), squared(1), squared(2)};
  return static_cast<std::size_t>(std::ranges::max_element(lengths) - lengths.begin());
}

double longest_side(const RawMesh& surface, const Triangle& t) {
  const std::size_t k = longest_side_of(surface, t);
  return (surface.vertices[t[k]] - surface.vertices[t[(k + 1) % 3]]).norm();
}

/// The largest rounding_at() of a triangle's corners.
double rounding_of(const RawMesh& surface, const Triangle& t) {
  return std::max(
      {rounding_at(surface.vertices[t[0]]), rounding_at(surface.vertices[t[1]]), rounding_at(surface.vertices[t[2]])});
}

}  // namespace

bool is_degenerate(const RawMesh& surface, const Triangle& t) {
  return surface.normal(t).norm() <= rounding_of(surface, t) * longest_side(surface, t);
}

namespace {

/// Merges the ends of sides that are within rounding, where triangles are degenerate. @return repairs made
std::size_t merge_close_corners(RawMesh& surface, const std::vector<std::uint32_t>& degenerate, RepairLog& log) {
  UnionFind same(surface.vertices.size());
  std::size_t merged = 0;
  for (const std::uint32_t i : degenerate) {
    const Triangle& t = surface.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if ((surface.vertices[a] - surface.vertices[b]).norm() > rounding_of(surface, t)) continue;
      if (same.find(a) == same.find(b)) continue;
      same.join(std::max(same.find(a), same.find(b)), std::min(same.find(a), same.find(b)));
      ++merged;
    }
  }
  if (merged == 0) return 0;
  std::vector<std::uint32_t> number(surface.vertices.size());
  for (std::uint32_t v = 0; v < number.size(); ++v) number[v] = same.find(v);
  renumber(surface, number, log);
  return merged;
}

/// Takes degenerate triangles out by splitting their neighbours at the longest edge; each triangle is touched once.
class Splitter {
 public:
  Splitter(RawMesh& surface, RepairLog& log)
      : surface_(surface), log_(log), sides_(sorted_sides(surface.triangles)), gone_(surface.triangles.size(), 0) {}

  /// @return repairs made
  std::size_t run(const std::vector<std::uint32_t>& degenerate) {
    std::size_t made = 0;
    for (const std::uint32_t i : degenerate) made += gone_[i] == 0 && take_out(i) ? 1 : 0;
    if (made > 0) erase_marked(surface_.triangles, gone_);
    return made;
  }

 private:
  std::span<const Side> sides_at(std::uint32_t a, std::uint32_t b) const {
    const auto [low, high] = std::minmax(a, b);
    const auto before = [](const Side& x, const Side& y) { return std::tie(x.low, x.high) < std::tie(y.low, y.high); };
    const auto [begin, end] = std::equal_range(sides_.begin(), sides_.end(), Side{low, high, 0, true}, before);
    return {begin, end};
  }

  /// Whether the side's triangle is degenerate, too, and has a longer side. Then splitting it here would leave parts as
  /// long as before, and might never end.
  bool must_go_first(const Side& side) const {
    const Triangle& t = surface_.triangles[side.triangle()];
    const double shared = (surface_.vertices[side.low] - surface_.vertices[side.high]).norm();
    return is_degenerate(surface_, t) && longest_side(surface_, t) > shared;
  }

  bool take_out(std::uint32_t i) {
    const Triangle t = surface_.triangles[i];
    const std::size_t k = longest_side_of(surface_, t);
    const std::uint32_t c = t[(k + 2) % 3];
    const std::span<const Side> sides = sides_at(t[k], t[(k + 1) % 3]);
    if (sides.size() > 2) return false;
    if (sides.size() == 2) {
      const Side& other = sides[0].triangle() == i ? sides[1] : sides[0];
      if (gone_[other.triangle()] != 0 || must_go_first(other)) return false;
      const std::uint32_t d = apex_of(other, surface_.triangles);
      gone_[other.triangle()] = 1;
      if (d != c) {  // else the two lie on each other
        surface_.triangles.push_back({start_of(other), c, d});
        surface_.triangles.push_back({c, end_of(other), d});
      }
    }
    gone_[i] = 1;
    log_.add(RepairKind::degenerate_triangles, surface_.vertices[c]);
    return true;
  }

  RawMesh& surface_;
  RepairLog& log_;
  const std::vector<Side> sides_;
  std::vector<std::uint8_t> gone_;  ///< For the triangles that were there at first.
};

/// Degenerate triangles, those with the longest sides first.
std::vector<std::uint32_t> find_degenerate(const RawMesh& surface) {
  std::vector<std::pair<double, std::uint32_t>> found;
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i) {
    const Triangle& t = surface.triangles[i];
    if (is_degenerate(surface, t)) found.emplace_back(-longest_side(surface, t), i);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::uint32_t> numbers;
  for (const auto& entry : found) numbers.push_back(entry.second);
  return numbers;
}

}  // namespace

std::size_t drop_duplicates(RawMesh& surface, RepairLog& log) {
  std::size_t dropped =
      drop_from_groups(surface, log, [](const Key& first, const Key& other) { return first.odd == other.odd; });
  // Each round may make edges odd that others wait for.
  for (;;) {
    const std::vector<std::uint8_t> odd = at_odd_edges(surface.triangles);
    const std::size_t more = drop_from_groups(surface, log, [&](const Key& first, const Key& other) {
      return first.odd != other.odd && odd[other.triangle] != 0;
    });
    dropped += more;
    if (more == 0) return dropped;
  }
}

std::size_t drop_degenerate(RawMesh& surface, RepairLog& log) {
  // Each split replaces a side by a shorter one.
  constexpr int k_most_rounds = 64;
  std::size_t made = 0;
  for (int round = 0; round < k_most_rounds; ++round) {
    std::vector<std::uint32_t> degenerate = find_degenerate(surface);
    if (degenerate.empty()) break;
    if (const std::size_t merged = merge_close_corners(surface, degenerate, log); merged > 0) {
      made += merged;
      continue;
    }
    const std::size_t split = Splitter(surface, log).run(degenerate);
    made += split;
    if (split == 0) break;
  }
  return made;
}

}  // namespace sixdof::repairing
