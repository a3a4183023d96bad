#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/results/row.h>

/// Rows of many pairs, each of which stands for an object (collection.h) or for a shape with a number of triangles
/// (growth.h). Beside the rows of sixdof-bench there are, with the pair's name in RowFields::pair,
/// - one of query "set" for each pair: the processor time that its set took, or an error where it was not made as
/// asked;
/// - one of query "pair" for each algorithm that did not end on a pair: an error.

namespace sixdof::results {

struct RowGroup;

/// A query on a bucket.
using AskedBucket = std::pair<std::string, BucketKey>;

/// Where objects and numbers of triangles are compared.
const std::vector<AskedBucket>& compared_buckets();

/// The row's query and bucket, a volume in percent of its volume_unit. The query of a cast is "cast tumble/10".
/// @param fields with a bucket
AskedBucket asked_bucket(const RowFields& fields);

/// Something that is missing from the measurement of a pair, and why.
struct Missing {
  std::string pair;
  std::string algorithm, row;  ///< Empty where it is about the set.
  std::string why;
};
void to_json(nlohmann::json& json, const Missing& missing);

struct MeasuredPairs {
  std::vector<const RowFields*> pairs;  ///< Their rows of query "set".
  std::vector<Missing> sets_not_made, not_measured;
};

/// @param groups outlive the result
MeasuredPairs measured_pairs(std::span<const RowGroup> groups);

/// Whether it is a row of query "set" or "pair".
bool is_about_pair(const RowFields& fields);

}  // namespace sixdof::results
