#include <sixdof/results/growth.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include <sixdof/results/measured_pairs.h>
#include <sixdof/results/result_json.h>
#include <sixdof/results/row_group.h>

namespace sixdof::results {
namespace {

/// (quantity, value) pairs of a row.
std::vector<std::pair<std::string, double>> quantities_of(const RowGroup& group) {
  const RowFields& fields = group.fields();
  const auto time = group.mean_time();
  if (!time || group.is_special()) return {};
  if (fields.query == "set") return {{"set, s", time->value / 1e9}};
  if (fields.query == "prepare") return {{"prepare, ms", time->value / 1e6}, {"memory, bytes", group.count("bytes")}};
  if (!fields.bucket) return {};
  const auto& compared = compared_buckets();
  if (std::ranges::find(compared, asked_bucket(fields)) == compared.end()) return {};
  return {{fields.query + ", us", time->value / 1e3}};
}

}  // namespace

std::optional<PowerLaw> power_law(const PointsOfShapes& points) {
  std::vector<std::pair<double, double>> centred;  // logarithms less their means over the shape
  std::size_t shapes = 0;
  for (const auto& [shape, values] : points) {
    std::vector<std::pair<double, double>> logs;
    std::set<double> counts;
    double mean_x = 0.0, mean_y = 0.0;
    for (const auto& [triangles, value] : values) {
      if (!(triangles > 0.0 && value > 0.0)) continue;
      logs.emplace_back(std::log(triangles), std::log(value));
      counts.insert(triangles);
      mean_x += logs.back().first;
      mean_y += logs.back().second;
    }
    if (counts.size() < 2) continue;
    ++shapes;
    const auto n = static_cast<double>(logs.size());
    for (const auto& [x, y] : logs) centred.emplace_back(x - mean_x / n, y - mean_y / n);
  }
  if (centred.size() < shapes + 2) return std::nullopt;
  double xx = 0.0, xy = 0.0, residuals = 0.0;
  for (const auto& [x, y] : centred) {
    xx += x * x;
    xy += x * y;
  }
  const double exponent = xy / xx, freedom = static_cast<double>(centred.size() - shapes - 1);
  for (const auto& [x, y] : centred) residuals += std::pow(y - exponent * x, 2);
  return PowerLaw{exponent, student_t95(freedom) * std::sqrt(residuals / freedom / xx), centred.size()};
}

std::optional<double> value_at(const std::vector<std::pair<double, double>>& points, double triangles) {
  const auto found = std::ranges::find(points, triangles, &std::pair<double, double>::first);
  return found == points.end() ? std::nullopt : std::optional(found->second);
}

void to_json(nlohmann::json& json, const GrowthSeries& series) {
  json = {{"algorithm", series.algorithm}, {"quantity", series.quantity}, {"points", series.points}};
  if (!series.law) return;
  json["exponent"] = series.law->exponent;
  json["half_width"] = series.law->half_width;
  json["fitted"] = series.law->fitted;
}

void from_json(const nlohmann::json& json, GrowthSeries& series) {
  json.at("algorithm").get_to(series.algorithm);
  json.at("quantity").get_to(series.quantity);
  json.at("points").get_to(series.points);
  if (!json.contains("exponent")) return;
  series.law = {json.at("exponent").get<double>(), json.at("half_width").get<double>(),
                json.at("fitted").get<std::size_t>()};
}

std::vector<GrowthSeries> growth_of(std::span<const RowGroup> groups) {
  std::map<std::pair<std::string, std::string>, PointsOfShapes> all;
  for (const RowGroup& group : groups) {
    const RowFields& fields = group.fields();
    if (fields.shape.empty() || !fields.triangles || !group.faults.empty()) continue;
    for (const auto& [quantity, value] : quantities_of(group)) {
      all[{fields.algorithm, quantity}][fields.shape].emplace_back(*fields.triangles, value);
    }
  }
  std::vector<GrowthSeries> growth;
  for (auto& [key, points] : all) {
    for (auto& [shape, values] : points) std::ranges::sort(values);
    growth.push_back({.algorithm = key.first, .quantity = key.second, .points = points, .law = power_law(points)});
  }
  return growth;
}

void take_growth(const nlohmann::ordered_json& document, std::size_t file, std::vector<GrowthSeries>& growth) {
  take_elements(document, "growth", file, growth);
}

}  // namespace sixdof::results
