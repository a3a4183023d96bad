#include "bench/cli/table_collection.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/results/collection.h>
#include <sixdof/results/growth.h>

namespace sixdof::cli {
namespace {

using results::Collection;
using results::CollectionCell;
using results::GrowthSeries;

constexpr std::size_t k_most_causes = 20;

/// Buckets that have a column, in percent; the JSON has all.
struct Shown {
  const char* query;
  std::vector<double> distances, volumes;
};

bool is_shown(const std::string& query, const BucketKey& bucket) {
  if (query.starts_with("cast ")) return true;
  static const std::vector<Shown> list{{"distance", {0, 1, 5, 10, 20, 30}, {5}},
                                       {"collide", {0, 1, 5, 10, 20, 30}, {1, 5, 10}},
                                       {"respond", {0, 1, 5, 10, 20, 30}, {1, 2, 5, 10}}};
  const auto found = std::ranges::find(list, query, &Shown::query);
  if (found == list.end()) return false;
  const auto& percents = bucket.kind == BucketKind::distance ? found->distances : found->volumes;
  return std::ranges::find(percents, bucket.percent) != percents.end();
}

std::string line_of(const std::vector<std::string>& cells) { return fmt::format("| {} |\n", fmt::join(cells, " | ")); }

std::string head_of(const std::vector<std::string>& titles) {
  std::string rule = "|";
  for (std::size_t i = 0; i < titles.size(); ++i) rule += "---|";
  return line_of(titles) + rule + "\n";
}

std::string code(const std::string& text) { return fmt::format("`{}`", text); }

/// Three significant digits, from 10,000 on all with commas.
std::string us(double value) {
  if (value < 1e4) return fmt::format("{:.3g}", value);
  std::string text = fmt::format("{:.0f}", value);
  for (std::size_t end = text.size(); end > 3;) text.insert(end -= 3, ",");
  return text;
}

std::string where(const BucketKey& bucket) { return fmt::format("{} {:g} %", to_string(bucket.kind), bucket.percent); }

/// The cells of a partner and query: a line for each algorithm, a column for each bucket.
std::string times_table(const std::vector<const CollectionCell*>& cells) {
  std::set<BucketKey> buckets;
  std::map<std::string, std::map<BucketKey, const CollectionCell*>> lines;
  std::size_t most = 0;
  for (const CollectionCell* const cell : cells) {
    most = std::max(most, cell->objects);
    lines[cell->algorithm][cell->bucket] = cell;
    if (is_shown(cell->query, cell->bucket)) buckets.insert(cell->bucket);
  }
  if (buckets.empty()) return "";
  std::vector<std::string> titles{"algorithm"};
  for (const BucketKey& bucket : buckets) titles.push_back(where(bucket));
  std::string text = fmt::format(
      "\n**{}, {}**: mean over {} objects, us (10 %..90 % of the objects); in square brackets the number of "
      "objects "
      "where it is less\n\n{}",
      cells[0]->query, cells[0]->partner, most, head_of(titles));
  for (const auto& [algorithm, of_buckets] : lines) {
    std::vector<std::string> line{code(algorithm)};
    for (const BucketKey& bucket : buckets) {
      const auto found = of_buckets.find(bucket);
      line.emplace_back("-");
      if (found == of_buckets.end()) continue;
      const CollectionCell& cell = *found->second;
      line.back() = fmt::format("{} ({}..{})", us(cell.mean_us), us(cell.p10_us), us(cell.p90_us));
      if (cell.objects < most) line.back() += fmt::format(" [{}]", cell.objects);
    }
    text += line_of(line);
  }
  return text;
}

std::string ratios_table(const Collection& collection) {
  std::string text = fmt::format(
      "\nTime / time of `{}` on the same object (geometric mean over buckets and objects):\n\n{}",
      results::k_collection_reference,
      head_of({"partner", "query", "algorithm", "objects", "ratio", "10 %..90 %", "faster on", "worst objects"}));
  for (const auto& each : collection.ratios) {
    if (each.algorithm == results::k_collection_reference) continue;
    std::vector<std::string> worst;
    for (const auto& [object, ratio] : each.worst) worst.push_back(fmt::format("{} {:.3g}", object, ratio));
    text += line_of({each.partner, each.query, code(each.algorithm), std::to_string(each.objects),
                     fmt::format("{:.3g}", each.ratio), fmt::format("{:.3g}..{:.3g}", each.p10, each.p90),
                     std::to_string(each.faster), fmt::format("{}", fmt::join(worst, ", "))});
  }
  return text;
}

std::string hardness_table(const Collection& collection) {
  std::set<std::string> kinds;
  for (const auto& each : collection.hardness) {
    for (const auto& [kind, values] : each.kinds) kinds.insert(kind);
  }
  if (kinds.empty()) return "";
  std::vector<std::string> titles{"query", "algorithm", "e"};
  titles.insert(titles.end(), kinds.begin(), kinds.end());
  std::string text =
      "\nWhat makes an object hard: time / what the number of triangles n alone says, c n^e (geometric mean over the "
      "objects of a kind; in brackets their number):\n\n" +
      head_of(titles);
  for (const auto& each : collection.hardness) {
    std::vector<std::string> line{fmt::format("{}, {}", each.query, where(each.bucket)), code(each.algorithm),
                                  fmt::format("{:.2f}", each.exponent)};
    for (const std::string& kind : kinds) {
      const auto found = each.kinds.find(kind);
      line.push_back(
          found == each.kinds.end() ? "-" : fmt::format("{:.2f} ({})", found->second.factor, found->second.objects));
    }
    text += line_of(line);
  }
  return text;
}

/// What is missing, with equal causes in one line, the most frequent first.
std::string missing_text(const char* title, const std::vector<results::Missing>& list) {
  if (list.empty()) return "";
  std::vector<std::pair<std::string, std::vector<std::string>>> causes;
  for (const results::Missing& each : list) {
    const std::string what = each.algorithm.empty() ? each.row.substr(0, each.row.find("/pair:")) : each.algorithm;
    const std::string cause = fmt::format("{}{}{}", what, what.empty() ? "" : ": ", each.why);
    auto found = std::ranges::find(causes, cause, [](const auto& entry) { return entry.first; });
    if (found == causes.end()) found = causes.insert(causes.end(), {cause, {}});
    found->second.push_back(each.pair);
  }
  std::ranges::stable_sort(causes, std::ranges::greater(), [](const auto& entry) { return entry.second.size(); });
  std::string text = fmt::format("\n{}: {}\n", title, list.size());
  for (std::size_t i = 0; i < std::min(causes.size(), k_most_causes); ++i) {
    const auto& [cause, pairs] = causes[i];
    text += pairs.size() == 1 ? fmt::format("  {}: {}\n", pairs[0], cause)
                              : fmt::format("  {} x {}\n", pairs.size(), cause);
  }
  return text;
}

std::string missing_text(const results::MeasuredPairs& pairs) {
  return missing_text("Sets that were not made as chosen", pairs.sets_not_made) +
         missing_text("Algorithms that did not end", pairs.not_measured);
}

Collection collection_in(const std::vector<results::RowGroup>& groups) {
  Collection collection = results::collection_of(groups);
  if (collection.objects.empty()) throw BadArgument("no rows of bench/scripts/collection: no row has a partner");
  return collection;
}

std::vector<GrowthSeries> growth_in(const std::vector<results::RowGroup>& groups) {
  if (std::ranges::none_of(groups, [](const auto& group) { return !group.fields().shape.empty(); })) {
    throw BadArgument("no rows of bench/scripts/growth: no row has a shape");
  }
  return results::growth_of(groups);
}

std::string law_text(const GrowthSeries* series) {
  if (series == nullptr || !series->law) return "-";
  return fmt::format("{:.2f} ± {:.2f}", series->law->exponent, series->law->half_width);
}

/// A line for each algorithm, a column for each quantity.
std::string exponents_table(const std::vector<GrowthSeries>& growth) {
  std::map<std::string, std::map<std::string, const GrowthSeries*>> lines;
  for (const GrowthSeries& series : growth) lines[series.algorithm][series.quantity] = &series;
  const GrowthSeries* const set = lines[results::k_set_maker]["set, s"];
  lines.erase(results::k_set_maker);
  std::string text = head_of({"algorithm", "prepare", "memory", "distance", "collide", "respond"});
  for (auto& [algorithm, of] : lines) {
    text += line_of({code(algorithm), law_text(of["prepare, ms"]), law_text(of["memory, bytes"]),
                     law_text(of["distance, us"]), law_text(of["collide, us"]), law_text(of["respond, us"])});
  }
  if (set != nullptr && set->law) text += fmt::format("\nMaking the set (`sixdof generate`): {}\n", law_text(set));
  return text;
}

/// The same number of triangles in different shapes, the fastest shape first.
std::string shapes_table(const std::vector<GrowthSeries>& growth, double triangles) {
  std::string text = head_of({fmt::format("at {} triangles", triangles), "shapes, us"});
  for (const GrowthSeries& series : growth) {
    std::vector<std::pair<double, std::string>> values;
    for (const auto& [shape, points] : series.points) {
      if (const auto value = results::value_at(points, triangles)) values.emplace_back(*value, shape);
    }
    if (!series.quantity.ends_with("us") || values.size() < 2) continue;
    std::ranges::sort(values);
    std::vector<std::string> words;
    for (const auto& [value, shape] : values) words.push_back(fmt::format("{} {:.3g}", shape, value));
    text += line_of({fmt::format("`{}` {}", series.algorithm, series.quantity.substr(0, series.quantity.find(','))),
                     fmt::format("{}", fmt::join(words, ", "))});
  }
  return text;
}

/// That most pairs have, of equally frequent ones the largest.
double most_frequent_triangles(const results::MeasuredPairs& pairs) {
  std::map<double, std::size_t> counts;
  for (const results::RowFields* const fields : pairs.pairs)
    ++counts[static_cast<double>(fields->triangles.value_or(0))];
  std::pair<std::size_t, double> best;
  for (const auto& [triangles, count] : counts) best = std::max(best, {count, triangles});
  return best.second;
}

}  // namespace

std::string over_objects_text(const std::vector<results::RowGroup>& groups) {
  const Collection collection = collection_in(groups);
  std::map<std::pair<std::string, std::string>, std::vector<const CollectionCell*>> tables;
  for (const CollectionCell& cell : collection.cells) tables[{cell.partner, cell.query}].push_back(&cell);
  std::string text = fmt::format("{} pairs of {} objects.\n", collection.pairs.pairs.size(), collection.objects.size());
  for (const auto& [key, cells] : tables) text += times_table(cells);
  return text + ratios_table(collection) + hardness_table(collection) + missing_text(collection.pairs) +
         missing_text("Faults", collection.faults);
}

std::string growth_text(const std::vector<results::RowGroup>& groups) {
  const std::vector<GrowthSeries> growth = growth_in(groups);
  const results::MeasuredPairs pairs = results::measured_pairs(groups);
  return fmt::format("{} pairs. Exponents of the number of triangles, with 95 % intervals:\n\n{}\n{}{}",
                     pairs.pairs.size(), exponents_table(growth), shapes_table(growth, most_frequent_triangles(pairs)),
                     missing_text(pairs));
}

nlohmann::json over_objects_json(const std::vector<results::RowGroup>& groups) {
  return {{"collection", results::to_json_object(collection_in(groups))}};
}

nlohmann::json growth_json(const std::vector<results::RowGroup>& groups) { return {{"growth", growth_in(groups)}}; }

}  // namespace sixdof::cli
