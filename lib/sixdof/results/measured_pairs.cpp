#include <sixdof/results/measured_pairs.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/results/row_group.h>

namespace sixdof::results {

const std::vector<AskedBucket>& compared_buckets() {
  static const std::vector<AskedBucket> list{{"distance", {BucketKind::distance, 5.0}},
                                             {"collide", {BucketKind::distance, 1.0}},
                                             {"respond", {BucketKind::volume, 5.0}}};
  return list;
}

AskedBucket asked_bucket(const RowFields& fields) {
  BucketKey bucket = *fields.bucket;
  if (bucket.kind == BucketKind::volume && fields.volume_unit) {
    bucket.percent = std::stod(fmt::format("{:.6g}", bucket.percent / *fields.volume_unit));
  }
  // All casts are on the bucket of contact: what tells them apart is how B moves.
  return {fields.query == k_cast ? fmt::format("cast {}", fields.order) : fields.query, bucket};
}

void to_json(nlohmann::json& json, const Missing& missing) {
  json = {{"unit", missing.pair}, {"why", missing.why}};
  if (!missing.algorithm.empty()) json["algorithm"] = missing.algorithm;
  if (!missing.row.empty()) json["row"] = missing.row;
}

MeasuredPairs measured_pairs(std::span<const RowGroup> groups) {
  MeasuredPairs found;
  for (const RowGroup& group : groups) {
    const RowFields& fields = group.fields();
    const std::string& error = group.row().error;
    if (fields.query == "set") {
      found.pairs.push_back(&fields);
      if (!error.empty()) found.sets_not_made.push_back({fields.pair, {}, {}, error});
    } else if (fields.query == "pair") {
      found.not_measured.push_back({fields.pair, fields.algorithm, {}, error});
    }
  }
  return found;
}

bool is_about_pair(const RowFields& fields) { return fields.query == "set" || fields.query == "pair"; }

}  // namespace sixdof::results
