#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/configuration/bucket.h>

/// What `bench/collection` and `bench/growth` make of their rows.

namespace sixdof::results {

/// One algorithm on all objects of the collection in one bucket; times in us of one query.
struct CollectionCell {
  std::size_t file = 0;
  std::string partner, query, algorithm, greatest_object;
  BucketKey bucket;
  double objects = 0.0;
  double mean_us = 0.0, p10_us = 0.0, p90_us = 0.0;  ///< Over the objects.
  double greatest_us = 0.0;                          ///< Of greatest_object.
};

/// Time over that of `exact` on the same object: geometric mean over objects, quantiles, the objects where it is
/// largest.
struct CollectionRatio {
  struct Worst {
    std::string object;
    double ratio = 0.0;
  };
  std::size_t file = 0;
  std::string partner, query, algorithm;
  double objects = 0.0, ratio = 0.0, p10 = 0.0, p90 = 0.0;
  std::vector<Worst> worst;
};

/// One quantity of one algorithm over the number of triangles.
struct GrowthSeries {
  std::size_t file = 0;
  std::string algorithm, quantity;
  std::map<std::string, std::vector<std::pair<double, double>>> points;  ///< By shape: triangles, value.
  std::optional<double> exponent, half_width;  ///< Common to the shapes, and half of its 95 % interval.
};

struct Collection {
  std::vector<CollectionCell> cells;
  std::vector<CollectionRatio> ratios;
  std::vector<GrowthSeries> growth;
};

/// Adds what the members "collection" and "growth" of a result file have, if it has them.
/// @throws Error with what is wrong
void take_collection(const nlohmann::ordered_json& document, std::size_t file, Collection& collection);

}  // namespace sixdof::results
