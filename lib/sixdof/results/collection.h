#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/results/measured_pairs.h>

/// Times over many objects, of the rows of `bench/scripts/collection` (measured_pairs.h). Each object meets several
/// partners, such as its copy ("self"), which are kept apart.

namespace sixdof::results {

/// One algorithm on all objects in one bucket; times in us of one query, over the objects. Behind the name of an
/// algorithm stands here and below the class of its rows (class_of()), if they have one: "coal (python)".
struct CollectionCell {
  std::size_t file = 0;
  std::string partner = {}, query = {}, algorithm = {}, greatest_object = {};
  BucketKey bucket = {};
  std::size_t objects = 0;
  double mean_us = 0.0, median_us = 0.0, p10_us = 0.0, p90_us = 0.0;
  double least_us = 0.0, greatest_us = 0.0;  ///< The greatest of greatest_object.
};

/// The algorithm that others are compared with on the same object.
inline constexpr const char* k_collection_reference = "exact";

/// Time over that of the reference on the same object, as geometric mean over buckets, and over objects.
struct CollectionRatio {
  struct Of {
    std::string object = {};
    double ratio = 0.0;
  };
  std::size_t file = 0;
  std::string partner = {}, query = {}, algorithm = {};
  std::size_t objects = 0;
  double ratio = 0.0, p10 = 0.0, p90 = 0.0;
  std::size_t faster = 0;      ///< Objects on which the algorithm takes less time.
  std::vector<Of> worst = {};  ///< Largest first.
  Of least = {};
};

/// By how much objects of a kind take more time than their number of triangles says: a power law through all objects
/// with themselves as partners.
struct CollectionHardness {
  struct Kind {
    std::size_t objects = 0;
    double factor = 0.0;  ///< Geometric mean of time over that of the law.
  };
  std::string query, algorithm;
  BucketKey bucket;
  double exponent = 0.0;  ///< Of the number of triangles.
  std::map<std::string, Kind> kinds;
};

struct Collection {
  std::vector<CollectionCell> cells;
  std::vector<CollectionRatio> ratios;
  std::vector<CollectionHardness> hardness;
  std::vector<std::string> objects;
  MeasuredPairs pairs;
  std::vector<Missing> faults;  ///< Rows that count for no time.
};

/// From the rows with a partner. @param groups outlive the result
Collection collection_of(std::span<const RowGroup> groups);

/// The member "collection" of a result file: all of it but the files.
nlohmann::json to_json_object(const Collection& collection);

/// Adds the cells and ratios of the member "collection" of a result file, if it has one. @throws Error with what is
/// wrong
void take_collection(const nlohmann::ordered_json& document, std::size_t file, Collection& collection);

}  // namespace sixdof::results
