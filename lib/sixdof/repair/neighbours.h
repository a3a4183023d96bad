#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nanoflann.hpp>

namespace sixdof::repairing {

/// What a search is given and finds, a place and a squared distance, in nanoflann 1.5 and later, and before.
#if NANOFLANN_VERSION >= 0x150
using Found = nanoflann::ResultItem<std::uint32_t, double>;
inline nanoflann::SearchParameters unsorted() { return nanoflann::SearchParameters(0.0F, false); }
#else
using Found = std::pair<std::uint32_t, double>;
inline nanoflann::SearchParams unsorted() { return nanoflann::SearchParams(0, 0.0F, false); }
#endif

/// Points by position: a k-d tree of nanoflann.
class Neighbours {
 public:
  /// @param vertices outlive this object; @param chosen the numbers of those to look for
  Neighbours(std::span<const Eigen::Vector3d> vertices, std::vector<std::uint32_t> chosen)
      : cloud_{vertices, std::move(chosen)}, tree_(3, cloud_) {}

  /// Numbers of the chosen vertices closer than `radius` to `p`, in ascending order.
  std::vector<std::uint32_t> within(const Eigen::Vector3d& p, double radius) const {
    std::vector<Found> found;
    tree_.radiusSearch(p.data(), radius * radius, found, unsorted());
    std::vector<std::uint32_t> numbers;
    numbers.reserve(found.size());
    for (const auto& [i, squared] : found) numbers.push_back(cloud_.chosen[i]);
    std::sort(numbers.begin(), numbers.end());
    return numbers;
  }

  /// Numbers of the `count` chosen vertices closest to `p`, or of all if there are fewer, the closest first.
  std::vector<std::uint32_t> nearest(const Eigen::Vector3d& p, std::size_t count) const {
    std::vector<std::uint32_t> numbers(count);
    std::vector<double> squared(count);
    numbers.resize(tree_.knnSearch(p.data(), count, numbers.data(), squared.data()));
    for (std::uint32_t& i : numbers) i = cloud_.chosen[i];
    return numbers;
  }

 private:
  struct Cloud {
    std::span<const Eigen::Vector3d> vertices;
    std::vector<std::uint32_t> chosen;

    std::size_t kdtree_get_point_count() const { return chosen.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return vertices[chosen[i]][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box& /*box*/) const {
      return false;
    }
  };
  using KdTree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;

  Cloud cloud_;
  KdTree tree_;
};

}  // namespace sixdof::repairing
