#include <sixdof/geometry/tree_builder.h>

#include <utility>

#include <sixdof/base/parallel.h>

namespace sixdof::tree_builder {
namespace {

constexpr std::size_t k_bins = 16;
constexpr std::size_t k_full_node = Tree::k_width * Tree::k_leaf_triangles;  // triangles of a node with full leaves
constexpr std::size_t k_full_two_levels = Tree::k_width * k_full_node;       // of a node with full nodes

/// How much more a cut may cost that leaves full nodes.
constexpr float k_worth = 1.1f;

/// What a range of triangles is split at multiples of. Parts that are not larger stay whole.
std::size_t block_of(std::size_t triangles) {
  if (triangles <= k_full_node) return Tree::k_leaf_triangles;
  return triangles <= k_full_two_levels ? k_full_node : k_full_two_levels;
}

constexpr std::size_t k_parallel_subtree = 4096;  // smaller subtrees are built by one task
constexpr std::size_t k_parallel_bins = 1 << 17;  // larger ranges are binned by several

/// A triangle while the tree is built.
struct Primitive {
  Box box;
  std::uint32_t triangle = 0;
  std::array<float, 3> twice_center() const {
    return {box.lower[0] + box.upper[0], box.lower[1] + box.upper[1], box.lower[2] + box.upper[2]};
  }
};

/// Box and number of the triangles in each bin, by axis.
struct Bins {
  std::array<std::array<Box, k_bins>, 3> box;
  std::array<std::array<std::uint32_t, k_bins>, 3> count{};

  void add(const Bins& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < k_bins; ++i) {
        box[k][i].add(other.box[k][i]);
        count[k][i] += other.count[k][i];
      }
    }
  }
};

/// Which bin a triangle is in: by the centre of its box.
struct Binning {
  std::array<float, 3> lower{};
  std::array<float, 3> scale{};  // bins per length; 0 where all centres agree

  explicit Binning(const Box& centers) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower[k] = centers.lower[k];
      const float extent = centers.upper[k] - centers.lower[k];
      const float bins_per_length = static_cast<float>(k_bins) * (1.0f - 1e-6f) / extent;
      scale[k] = extent > 0.0f && std::isfinite(bins_per_length) ? bins_per_length : 0.0f;
    }
  }
  std::size_t bin(float twice_center, std::size_t axis) const {
    const auto i = static_cast<std::size_t>((twice_center - lower[axis]) * scale[axis]);
    return std::min(i, k_bins - 1);
  }
};

/// fold(first, last) of the whole range. T::add() is exact and associative: the result does not depend on the parts.
template <class T, class Fold>
T fold_in_parallel(std::size_t first, std::size_t last, const Fold& fold) {
  if (last - first < k_parallel_bins) return fold(first, last);
  return parallel::reduce<T>(
      last - first, k_parallel_bins / 8,
      [&](std::size_t begin, std::size_t end) { return fold(first + begin, first + end); },
      [](T x, const T& y) {
        x.add(y);
        return x;
      });
}

/// Leaves hold up to four triangles, so the cost of a side is its area times the leaves it needs.
float cost(float half_area, std::size_t count) {
  const std::size_t leaves = (count + Tree::k_leaf_triangles - 1) / Tree::k_leaf_triangles;
  return half_area * static_cast<float>(leaves);
}

class Builder {
 public:
  Builder(const Surface& surface, const Eigen::Vector3d& center, std::span<const std::uint32_t> triangles)
      : primitives_(triangles.size()) {
    parallel::for_each(primitives_.size(), [&](std::size_t i) {
      Eigen::AlignedBox3d box;
      for (const std::uint32_t v : surface.triangles[triangles[i]]) box.extend(surface.vertices[v]);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        primitives_[i].box.lower[k] = round_down(box.min()[axis] - center[axis]);
        primitives_[i].box.upper[k] = round_up(box.max()[axis] - center[axis]);
      }
      primitives_[i].triangle = triangles[i];
    });
  }

  std::unique_ptr<Subtree> run(std::span<std::uint32_t> mesh_triangle) {
    const std::size_t n = primitives_.size();
    auto root = build(Range{0, n, bounds(0, n)});
    for (std::size_t i = 0; i < n; ++i) mesh_triangle[i] = primitives_[i].triangle;
    return root;
  }

 private:
  Box bounds(std::size_t first, std::size_t last) const {
    return fold_in_parallel<Box>(first, last, [this](std::size_t i, std::size_t end) {
      Box box;
      for (; i < end; ++i) box.add(primitives_[i].box);
      return box;
    });
  }

  /// A cut between two bins of an axis.
  struct BinCut {
    std::size_t axis = 3;  ///< 3: none, as all centres agree.
    std::size_t bin = 0;   ///< The first bin of the right part.
    float cost = std::numeric_limits<float>::infinity();
  };

  static BinCut best_cut(const Binning& binning, const Bins& bins) {
    BinCut best;
    for (std::size_t k = 0; k < 3; ++k) {
      if (binning.scale[k] == 0.0f) continue;
      std::array<float, k_bins> right_cost{};
      Box right;
      std::size_t right_count = 0;
      for (std::size_t i = k_bins - 1; i > 0; --i) {
        right.add(bins.box[k][i]);
        right_count += bins.count[k][i];
        right_cost[i] =
            right_count == 0 ? std::numeric_limits<float>::infinity() : cost(right.half_area(), right_count);
      }
      Box left;
      std::size_t left_count = 0;
      for (std::size_t i = 1; i < k_bins; ++i) {
        left.add(bins.box[k][i - 1]);
        left_count += bins.count[k][i - 1];
        if (left_count == 0) continue;
        const float sum = cost(left.half_area(), left_count) + right_cost[i];
        if (sum < best.cost) best = {k, i, sum};
      }
    }
    return best;
  }

  /// Cuts at the multiple of k_full_two_levels triangles that is nearest to the best cut between two bins, unless that
  /// costs more than full nodes are worth: where parts lie far from each other.
  std::array<Range, 2> split_by_bins(const Range& range) {
    const Box centers = fold_in_parallel<Box>(range.first, range.last, [this](std::size_t i, std::size_t end) {
      Box box;
      for (; i < end; ++i) box.add({primitives_[i].twice_center(), primitives_[i].twice_center()});
      return box;
    });
    const Binning binning(centers);
    const Bins bins = fold_in_parallel<Bins>(range.first, range.last, [&](std::size_t i, std::size_t end) {
      Bins sum;
      for (; i < end; ++i) {
        const std::array<float, 3> center = primitives_[i].twice_center();
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t bin = binning.bin(center[k], k);
          sum.box[k][bin].add(primitives_[i].box);
          ++sum.count[k][bin];
        }
      }
      return sum;
    });
    const BinCut best = best_cut(binning, bins);
    if (best.axis == 3) return cut_after(range, aligned(range, range.count() / 2));  // any halves will do

    const auto begin = primitives_.begin() + static_cast<std::ptrdiff_t>(range.first);
    const auto end = primitives_.begin() + static_cast<std::ptrdiff_t>(range.last);
    const auto between = std::partition(
        begin, end, [&](const Primitive& p) { return binning.bin(p.twice_center()[best.axis], best.axis) < best.bin; });
    const auto count = static_cast<std::size_t>(between - begin);
    const auto cut = begin + static_cast<std::ptrdiff_t>(aligned(range, count));
    const auto key = [&](const Primitive& p) { return std::pair(p.twice_center()[best.axis], p.triangle); };
    const auto is_before = [&](const Primitive& x, const Primitive& y) { return key(x) < key(y); };
    if (cut < between) std::nth_element(begin, cut, between, is_before);
    if (cut > between) std::nth_element(between, cut, end, is_before);
    const std::array<Range, 2> halves = cut_after(range, aligned(range, count));
    const auto cost_of = [](const Range& half) { return cost(half.box.half_area(), half.count()); };
    return cost_of(halves[0]) + cost_of(halves[1]) <= k_worth * best.cost ? halves : cut_after(range, count);
  }

  std::array<Range, 2> cut_after(const Range& range, std::size_t count) const {
    const std::size_t middle = range.first + count;
    return {Range{range.first, middle, bounds(range.first, middle)},
            Range{middle, range.last, bounds(middle, range.last)}};
  }

  /// The multiple of k_full_two_levels that is nearest to `count` and leaves triangles on both sides.
  static std::size_t aligned(const Range& range, std::size_t count) {
    constexpr std::size_t k_block = k_full_two_levels;
    return std::clamp<std::size_t>((count + k_block / 2) / k_block, 1, (range.count() - 1) / k_block) * k_block;
  }

  /// The best of all cuts at multiples of `block` triangles, for ranges of up to k_width blocks and k_full_two_levels.
  std::array<Range, 2> split_exactly(const Range& range, std::size_t block) {
    const std::size_t n = range.count();
    const auto begin = primitives_.begin() + static_cast<std::ptrdiff_t>(range.first);
    std::array<Primitive, k_full_two_levels> sorted;
    std::array<Primitive, k_full_two_levels> best;
    float best_cost = std::numeric_limits<float>::infinity();
    Range left{range.first, range.first, {}};
    Range right{range.last, range.last, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<std::pair<float, std::uint32_t>, k_full_two_levels> order;
      for (std::size_t i = 0; i < n; ++i) {
        order[i] = {begin[static_cast<std::ptrdiff_t>(i)].twice_center()[k], static_cast<std::uint32_t>(i)};
      }
      std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n));
      for (std::size_t i = 0; i < n; ++i) sorted[i] = begin[static_cast<std::ptrdiff_t>(order[i].second)];

      std::array<Box, Tree::k_width + 1> tail;  // boxes of the triangles right of each cut
      const std::size_t last_cut = (n - 1) / block;
      std::size_t end = n;
      for (std::size_t cut = last_cut; cut > 0; --cut) {
        if (cut < last_cut) tail[cut] = tail[cut + 1];
        for (std::size_t i = cut * block; i < end; ++i) tail[cut].add(sorted[i].box);
        end = cut * block;
      }
      Box head;
      bool improved = false;
      for (std::size_t cut = 1; cut <= last_cut; ++cut) {
        for (std::size_t i = (cut - 1) * block; i < cut * block; ++i) head.add(sorted[i].box);
        const float sum =
            head.half_area() * static_cast<float>(cut) + tail[cut].half_area() * static_cast<float>(last_cut + 1 - cut);
        if (sum < best_cost) {
          best_cost = sum;
          improved = true;
          left = {range.first, range.first + cut * block, head};
          right = {range.first + cut * block, range.last, tail[cut]};
        }
      }
      if (improved) std::copy_n(sorted.begin(), n, best.begin());
    }
    std::copy_n(best.begin(), n, begin);
    return {left, right};
  }

  std::unique_ptr<Subtree> build(const Range& range) {
    auto subtree = std::make_unique<Subtree>();
    std::vector<Range>& children = subtree->children;
    children.push_back(range);
    const std::size_t block = block_of(range.count());
    while (children.size() < Tree::k_width) {
      std::size_t widest = children.size();
      float widest_area = -1.0f;
      for (std::size_t i = 0; i < children.size(); ++i) {
        if (children[i].count() > block && children[i].box.half_area() > widest_area) {
          widest = i;
          widest_area = children[i].box.half_area();
        }
      }
      if (widest == children.size()) break;
      const Range whole = children[widest];
      const std::array<Range, 2> halves =
          whole.count() <= k_full_two_levels ? split_exactly(whole, block) : split_by_bins(whole);
      children[widest] = halves[0];
      children.push_back(halves[1]);
    }
    // A subtree's triangles are consecutive, in the order of the children.
    std::sort(children.begin(), children.end(), [](const Range& x, const Range& y) { return x.first < y.first; });

    subtree->nodes.resize(children.size());
    const auto build_child = [&](std::size_t i) {
      if (children[i].count() > Tree::k_leaf_triangles) subtree->nodes[i] = build(children[i]);
    };
    if (range.count() > k_parallel_subtree) {
      parallel::for_each(children.size(), build_child);
    } else {
      for (std::size_t i = 0; i < children.size(); ++i) build_child(i);
    }
    for (const auto& node : subtree->nodes) subtree->total += node ? node->total : 0;
    return subtree;
  }

  std::vector<Primitive> primitives_;  ///< In tree order once all is built.
};

}  // namespace

namespace {

void shift(Subtree& subtree, std::size_t first) {
  for (Range& range : subtree.children) {
    range.first += first;
    range.last += first;
  }
  for (const auto& node : subtree.nodes) {
    if (node) shift(*node, first);
  }
}

}  // namespace

std::unique_ptr<Subtree> build(const Surface& surface, const Eigen::Vector3d& center,
                               std::span<std::uint32_t> mesh_triangle, std::size_t first) {
  auto root = Builder(surface, center, mesh_triangle).run(mesh_triangle);
  if (first > 0) shift(*root, first);
  return root;
}

}  // namespace sixdof::tree_builder
