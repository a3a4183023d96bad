#include <sixdof/results/collection.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/results/growth.h>
#include <sixdof/results/result_json.h>
#include <sixdof/results/row_group.h>

template <>
struct nlohmann::adl_serializer<sixdof::BucketKey> {
  static void to_json(json& to, const sixdof::BucketKey& key) { to = sixdof::results::to_json_object(key); }
  static void from_json(const json& from, sixdof::BucketKey& key) { key = sixdof::results::bucket_of(from); }
};

namespace sixdof::results {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CollectionCell, partner, query, algorithm, greatest_object, bucket, objects, mean_us,
                                   median_us, p10_us, p90_us, least_us, greatest_us)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CollectionRatio::Of, object, ratio)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CollectionRatio, partner, query, algorithm, objects, ratio, p10, p90, faster, worst,
                                   least)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CollectionHardness::Kind, objects, factor)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CollectionHardness, query, algorithm, bucket, exponent, kinds)

namespace {

constexpr std::ptrdiff_t k_worst = 3;         ///< Objects that a ratio names.
constexpr std::size_t k_fewest_compared = 8;  ///< Objects for a law of the number of triangles.

/// By partner, query and bucket, and algorithm: ns by object.
using ByObject = std::map<std::string, double>;
using Times = std::map<std::tuple<std::string, AskedBucket, std::string>, ByObject>;

std::vector<double> values_of(const ByObject& by_object) {
  std::vector<double> values;
  values.reserve(by_object.size());
  for (const auto& [object, value] : by_object) values.push_back(value);
  return values;
}

CollectionCell cell_of(const ByObject& by_object) {
  std::vector<double> us = values_of(by_object);
  for (double& value : us) value /= 1e3;
  const auto greatest = std::ranges::max_element(by_object, {}, &ByObject::value_type::second);
  return {.greatest_object = greatest->first,
          .objects = us.size(),
          .mean_us = std::accumulate(us.begin(), us.end(), 0.0) / static_cast<double>(us.size()),
          .median_us = median(us),
          .p10_us = quantile(us, 0.1),
          .p90_us = quantile(us, 0.9),
          .least_us = std::ranges::min(us),
          .greatest_us = std::ranges::max(us)};
}

CollectionRatio ratio_of(const ByObject& by_object) {
  const std::vector<double> ratios = values_of(by_object);
  std::vector<CollectionRatio::Of> ordered;
  for (const auto& [object, ratio] : by_object) ordered.push_back({object, ratio});
  const CollectionRatio::Of least = *std::ranges::min_element(ordered, {}, &CollectionRatio::Of::ratio);
  std::ranges::stable_sort(ordered, std::ranges::greater(), &CollectionRatio::Of::ratio);
  return {.objects = ratios.size(),
          .ratio = geometric_mean(ratios),
          .p10 = quantile(ratios, 0.1),
          .p90 = quantile(ratios, 0.9),
          .faster = static_cast<std::size_t>(std::ranges::count_if(ratios, [](double ratio) { return ratio < 1.0; })),
          .worst = {ordered.begin(), ordered.begin() + std::min(k_worst, std::ssize(ordered))},
          .least = least};
}

/// The response ratio is of bodies that overlap.
bool is_apart_response(const AskedBucket& asked) {
  return asked.first == "respond" && asked.second.kind == BucketKind::distance;
}

std::vector<CollectionRatio> ratios_of(const Times& times) {
  std::map<std::tuple<std::string, std::string, std::string>, std::map<std::string, std::vector<double>>> all;
  for (const auto& [key, by_object] : times) {
    const auto& [partner, asked, algorithm] = key;
    if (is_apart_response(asked)) continue;
    const auto reference = times.find({partner, asked, k_collection_reference});
    if (reference == times.end()) continue;
    for (const auto& [object, ns] : by_object) {
      const auto found = reference->second.find(object);
      if (found != reference->second.end())
        all[{partner, asked.first, algorithm}][object].push_back(ns / found->second);
    }
  }
  std::vector<CollectionRatio> ratios;
  for (const auto& [key, by_object] : all) {
    ByObject means;
    for (const auto& [object, of_buckets] : by_object) means[object] = geometric_mean(of_buckets);
    ratios.push_back(ratio_of(means));
    std::tie(ratios.back().partner, ratios.back().query, ratios.back().algorithm) = key;
  }
  return ratios;
}

/// @param objects a row of each
CollectionHardness hardness_of(const ByObject& by_object, const std::map<std::string, const RowFields*>& objects) {
  std::map<std::string, double> triangles;
  PointsOfShapes points;
  for (const auto& [object, ns] : by_object) {
    triangles[object] = static_cast<double>(objects.at(object)->triangles.value_or(1));
    points[""].emplace_back(triangles[object], ns);
  }
  CollectionHardness hardness;
  if (const auto law = power_law(points)) hardness.exponent = law->exponent;
  std::vector<double> all;  // factor of the law
  std::map<std::string, std::vector<double>> kinds;
  for (const auto& [object, ns] : by_object) {
    all.push_back(ns / std::pow(triangles[object], hardness.exponent));
    kinds[objects.at(object)->kind].push_back(all.back());
  }
  for (const auto& [kind, values] : kinds) {
    hardness.kinds[kind] = {.objects = values.size(), .factor = geometric_mean(values) / geometric_mean(all)};
  }
  return hardness;
}

}  // namespace

Collection collection_of(std::span<const RowGroup> groups) {
  Collection collection;
  collection.pairs = measured_pairs(groups);
  Times times;
  std::map<std::string, const RowFields*> objects;
  for (const RowGroup& group : groups) {
    const RowFields& fields = group.fields();
    if (fields.partner.empty()) continue;
    objects[fields.object] = &fields;
    if (is_about_pair(fields)) continue;
    if (!group.faults.empty()) {
      collection.faults.push_back(
          {fmt::format("{}.{}", fields.object, fields.partner), {}, group.row().name, to_string(group.faults)});
    } else if (const auto time = group.mean_time(); time && fields.bucket && !group.is_special()) {
      const std::string apart = class_of(fields);
      const std::string name = apart.empty() ? fields.algorithm : fmt::format("{} ({})", fields.algorithm, apart);
      times[{fields.partner, asked_bucket(fields), name}][fields.object] = time->value;
    }
  }
  for (const auto& [object, fields] : objects) collection.objects.push_back(object);
  for (const auto& [key, by_object] : times) {
    CollectionCell& cell = collection.cells.emplace_back(cell_of(by_object));
    std::tie(cell.partner, std::ignore, cell.algorithm) = key;
    std::tie(cell.query, cell.bucket) = std::get<AskedBucket>(key);
  }
  collection.ratios = ratios_of(times);
  for (const AskedBucket& asked : compared_buckets()) {
    for (const auto& [key, by_object] : times) {
      const auto& [partner, query_and_bucket, algorithm] = key;
      if (partner != "self" || query_and_bucket != asked || by_object.size() < k_fewest_compared) continue;
      CollectionHardness& hardness = collection.hardness.emplace_back(hardness_of(by_object, objects));
      std::tie(hardness.query, hardness.bucket) = asked;
      hardness.algorithm = algorithm;
    }
  }
  return collection;
}

nlohmann::json to_json_object(const Collection& collection) {
  return {{"units", collection.pairs.pairs.size()},
          {"objects", collection.objects},
          {"cells", collection.cells},
          {fmt::format("against_{}", k_collection_reference), collection.ratios},
          {"hardness", collection.hardness},
          {"sets_not_made", collection.pairs.sets_not_made},
          {"not_measured", collection.pairs.not_measured},
          {"faults", collection.faults}};
}

void take_collection(const nlohmann::ordered_json& document, std::size_t file, Collection& collection) {
  if (!document.contains("collection")) return;
  take_elements(document.at("collection"), "cells", file, collection.cells);
  take_elements(document.at("collection"), "against_exact", file, collection.ratios);
}

}  // namespace sixdof::results
