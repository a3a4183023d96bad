#include <sixdof/report/collection.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/report/result_json.h>

namespace sixdof::report {
namespace {

using Json = nlohmann::ordered_json;

double number_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) throw Error(fmt::format("no number \"{}\"", key));
  return found->get<double>();
}

/// The objects of an array; none where there is no such member.
std::vector<Json> objects_of(const Json& parent, const char* key) {
  const auto found = parent.find(key);
  if (found == parent.end()) return {};
  if (!found->is_array()) throw Error(fmt::format("\"{}\" is no array", key));
  std::vector<Json> objects;
  for (const Json& each : *found) {
    if (!each.is_object()) throw Error(fmt::format("\"{}\" holds something that is no object", key));
    objects.push_back(each);
  }
  return objects;
}

CollectionCell cell_of(const Json& object, std::size_t file) {
  const Json bucket = object.value("bucket", Json::object());
  if (!bucket.is_object()) throw Error("\"bucket\" is no object");
  return {.file = file,
          .partner = text_at(object, "partner"),
          .query = text_at(object, "query"),
          .kind = text_at(bucket, "kind"),
          .algorithm = text_at(object, "algorithm"),
          .greatest_object = text_at(object, "greatest_object"),
          .percent = number_of(bucket, "percent"),
          .objects = number_of(object, "objects"),
          .mean_us = number_of(object, "mean_us"),
          .p10_us = number_of(object, "p10_us"),
          .p90_us = number_of(object, "p90_us"),
          .greatest_us = number_of(object, "greatest_us")};
}

CollectionRatio ratio_of(const Json& object, std::size_t file) {
  CollectionRatio ratio{.file = file,
                        .partner = text_at(object, "partner"),
                        .query = text_at(object, "query"),
                        .algorithm = text_at(object, "algorithm"),
                        .objects = number_of(object, "objects"),
                        .ratio = number_of(object, "ratio"),
                        .p10 = number_of(object, "p10"),
                        .p90 = number_of(object, "p90"),
                        .worst = {}};
  for (const Json& worst : objects_of(object, "worst")) {
    ratio.worst.emplace_back(text_at(worst, "object"), number_of(worst, "ratio"));
  }
  return ratio;
}

GrowthSeries growth_of(const Json& object, std::size_t file) {
  GrowthSeries series{.file = file,
                      .algorithm = text_at(object, "algorithm"),
                      .quantity = text_at(object, "quantity"),
                      .points = {},
                      .exponent = {},
                      .half_width = {}};
  if (object.contains("exponent")) {
    series.exponent = number_of(object, "exponent");
    series.half_width = number_of(object, "half_width");
  }
  const auto shapes = object.find("points");
  if (shapes == object.end() || !shapes->is_object()) throw Error("no object \"points\"");
  for (const auto& [shape, points] : shapes->items()) {
    for (const Json& point : points) {
      const bool is_point = point.is_array() && point.size() == 2 && point[0].is_number() && point[1].is_number();
      if (!is_point) throw Error(fmt::format("points of {}: not pairs of numbers", shape));
      series.points[shape].emplace_back(point[0].get<double>(), point[1].get<double>());
    }
  }
  return series;
}

}  // namespace

void take_collection(const Json& document, std::size_t file, Collection& collection) {
  if (const auto summary = document.find("collection"); summary != document.end()) {
    if (!summary->is_object()) throw Error("\"collection\" is no object");
    for (const Json& cell : objects_of(*summary, "cells")) collection.cells.push_back(cell_of(cell, file));
    for (const Json& ratio : objects_of(*summary, "against_exact")) {
      collection.ratios.push_back(ratio_of(ratio, file));
    }
  }
  for (const Json& series : objects_of(document, "growth")) collection.growth.push_back(growth_of(series, file));
}

}  // namespace sixdof::report
