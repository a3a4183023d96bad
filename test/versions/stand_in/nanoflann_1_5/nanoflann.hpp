#pragma once

#include <cstddef>
#include <vector>

/// What this project uses of nanoflann 1.5, to be compiled and not linked.
#define NANOFLANN_VERSION 0x150

namespace nanoflann {

template <class Index, class Distance>
struct ResultItem {
  Index first;
  Distance second;
};

struct SearchParameters {
  SearchParameters(float tolerance, bool sorted);
};

template <class Scalar, class Source>
struct L2_Simple_Adaptor;

template <class Distance, class Source, int dimension, class Index>
class KDTreeSingleIndexAdaptor {
 public:
  KDTreeSingleIndexAdaptor(int dimensions, const Source& source);
  std::size_t radiusSearch(const double* point, const double& radius, std::vector<ResultItem<Index, double>>& found,
                           const SearchParameters& parameters) const;
  std::size_t knnSearch(const double* point, std::size_t count, Index* indices, double* squared_distances) const;
};

}  // namespace nanoflann
