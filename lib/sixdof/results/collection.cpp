#include <sixdof/results/collection.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/results/result_json.h>
#include <sixdof/results/row_fields.h>

namespace sixdof::results {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CollectionCell, partner, query, algorithm, greatest_object, objects, mean_us, p10_us,
                                   p90_us, greatest_us)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CollectionRatio::Worst, object, ratio)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CollectionRatio, partner, query, algorithm, objects, ratio, p10, p90, worst)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GrowthSeries, algorithm, quantity, points)

namespace {

/// The elements of an array; none where there is no such member.
template <class Element>
std::vector<Element> elements_of(const nlohmann::json& parent, const char* key, std::size_t file) {
  const nlohmann::json list = parent.value(key, nlohmann::json::array());
  if (!list.is_array()) throw Error(fmt::format("\"{}\" is no array", key));
  std::vector<Element> elements;
  for (const nlohmann::json& each : list) {
    elements.push_back(each.get<Element>());
    elements.back().file = file;
    if constexpr (requires(Element e) { e.bucket; }) elements.back().bucket = bucket_of(each.at("bucket"));
    if constexpr (requires(Element e) { e.exponent; }) {
      if (!each.contains("exponent")) continue;
      elements.back().exponent = each.at("exponent").get<double>();
      elements.back().half_width = each.at("half_width").get<double>();
    }
  }
  return elements;
}

template <class Element>
void append(std::vector<Element> more, std::vector<Element>& list) {
  list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

void take_collection(const nlohmann::ordered_json& document, std::size_t file, Collection& collection) {
  try {
    if (document.contains("collection")) {
      const nlohmann::json summary = document.at("collection");
      append(elements_of<CollectionCell>(summary, "cells", file), collection.cells);
      append(elements_of<CollectionRatio>(summary, "against_exact", file), collection.ratios);
    }
    if (!document.contains("growth")) return;
    append(elements_of<GrowthSeries>({{"growth", document.at("growth")}}, "growth", file), collection.growth);
  } catch (const nlohmann::json::exception& e) {
    throw Error(words_of(e));
  }
}

}  // namespace sixdof::results
