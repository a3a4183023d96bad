#pragma once

#include <cstddef>
#include <utility>
#include <vector>

/// What this project uses of nanoflann 1.4, to be compiled and not linked.
#define NANOFLANN_VERSION 0x142

namespace nanoflann {

struct SearchParams {
  SearchParams(int ignored, float tolerance, bool sorted);
};

template <class Scalar, class Source>
struct L2_Simple_Adaptor;

template <class Distance, class Source, int dimension, class Index>
class KDTreeSingleIndexAdaptor {
 public:
  KDTreeSingleIndexAdaptor(int dimensions, const Source& source);
  std::size_t radiusSearch(const double* point, const double& radius, std::vector<std::pair<Index, double>>& found,
                           const SearchParams& parameters) const;
  std::size_t knnSearch(const double* point, std::size_t count, Index* indices, double* squared_distances) const;
};

}  // namespace nanoflann
