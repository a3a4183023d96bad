#include "bench/study/survey_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/measure/metrics.h>
#include <sixdof/results/result_json.h>
#include <sixdof/results/results.h>
#include "bench/common/json_text.h"

namespace sixdof::study {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SurveyIdentity, set, grid, pair, a, b, algorithm, version, settings, command,
                                   questions, approximates, isolated, runtime, shards, sample, seed)

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* k_format_key = "sixdof_survey_shard";
constexpr int k_format = 1;

/// The members of a cell that a file has under their names.
constexpr std::pair<const char*, std::uint64_t SurveyCell::*> k_counts[]{
    {"configurations", &SurveyCell::configurations},
    {"reachable", &SurveyCell::reachable},
    {"asked", &SurveyCell::asked},
    {"failed", &SurveyCell::failed},
    {"judged", &SurveyCell::judged},
    {"wrong", &SurveyCell::wrong},
    {"missed", &SurveyCell::missed},
    {"phantoms", &SurveyCell::phantoms}};
constexpr std::pair<const char*, double SurveyCell::*> k_values[]{{"sum_ns", &SurveyCell::sum_ns},
                                                                  {"max_ns", &SurveyCell::max_ns},
                                                                  {"max_least_ns", &SurveyCell::max_least_ns},
                                                                  {"error_sum", &SurveyCell::error_sum},
                                                                  {"error_squares", &SurveyCell::error_squares},
                                                                  {"error_max", &SurveyCell::error_max},
                                                                  {"force_sum", &SurveyCell::force_sum},
                                                                  {"phantom_sum", &SurveyCell::phantom_sum},
                                                                  {"phantom_max", &SurveyCell::phantom_max},
                                                                  {"seconds", &SurveyCell::seconds}};

Json to_json_object(const SurveyCell& cell) {
  Json json{{"query", to_string(cell.question)}, {"bucket", cell.key.name()}};
  for (const auto& [name, member] : k_counts) json[name] = cell.*member;
  for (const auto& [name, member] : k_values) json[name] = cell.*member;
  json["poses"] = cell.poses;
  return json;
}

SurveyCell cell_of(const Json& json) {
  SurveyCell cell;
  const auto query = json.at("query").get<std::string>();
  const auto* const kind = std::ranges::find(bench::k_query_kinds, query,
                                             [](bench::QueryKind each) { return std::string(to_string(each)); });
  if (kind == bench::k_query_kinds.end()) throw Error("unknown query " + query);
  cell.question = *kind;
  cell.key = BucketKey::parse(json.at("bucket").get<std::string>());
  for (const auto& [name, member] : k_counts) json.at(name).get_to(cell.*member);
  for (const auto& [name, member] : k_values) json.at(name).get_to(cell.*member);
  json.at("poses").get_to(cell.poses);
  return cell;
}

/// The shards of one algorithm, added up.
struct Whole {
  SurveyShard first;
  std::map<std::size_t, std::filesystem::path> files = {};  ///< By number.
  std::map<std::pair<bench::QueryKind, BucketKey>, SurveyCell> cells = {};
};

void add_shard(Whole& whole, const SurveyShard& shard, const std::filesystem::path& file) {
  if (shard.identity != whole.first.identity) {
    throw BadFile(file.string(), fmt::format("another survey of {} than {}: set, version, settings, queries, sample or "
                                             "number of shards differ",
                                             shard.identity.algorithm, whole.files.begin()->second.string()));
  }
  if (const auto [there, is_new] = whole.files.emplace(shard.number, file); !is_new) {
    throw BadArgument(fmt::format("{}: shard {} of {} is there twice, also in {}", file.string(), shard.number,
                                  shard.identity.algorithm, there->second.string()));
  }
  whole.first.prepare_ns = std::max(whole.first.prepare_ns, shard.prepare_ns);
  for (const SurveyCell& cell : shard.cells) {
    const auto [sum, is_new] = whole.cells.try_emplace({cell.question, cell.key}, cell);
    if (!is_new) add_to(sum->second, cell);
  }
}

void require_whole(const Whole& whole) {
  std::vector<std::size_t> missing;
  for (std::size_t number = 1; number <= whole.first.identity.shards; ++number) {
    if (!whole.files.contains(number)) missing.push_back(number);
  }
  if (missing.empty()) return;
  throw BadArgument(fmt::format("{}: {} of {} shards are missing: {}", whole.first.identity.algorithm, missing.size(),
                                whole.first.identity.shards, fmt::join(missing, ", ")));
}

/// Mean force at the least overlap, which forces of bodies that are apart are compared with (rows/query.cpp).
std::optional<double> force_scale(const Whole& whole) {
  for (const auto& [key, cell] : whole.cells) {  // by bucket
    const bool overlaps = key.second.kind == BucketKind::volume && key.second.percent > 0;
    if (key.first != bench::QueryKind::respond || !overlaps || cell.answered() == 0) continue;
    const double mean = cell.force_sum / static_cast<double>(cell.answered());
    return mean > 0.0 ? std::optional(mean) : std::nullopt;
  }
  return std::nullopt;
}

results::RowFields fields_of(const SurveyIdentity& identity, std::string query) {
  return {.query = std::move(query),
          .algorithm = identity.algorithm,
          .settings = identity.settings,
          .pair = identity.pair,
          .runtime = identity.runtime,
          .isolated = identity.isolated,
          .approximates = identity.approximates};
}

void add_errors(results::Row& row, const SurveyCell& cell, std::optional<double> scale) {
  const double answered = static_cast<double>(std::max<std::uint64_t>(1, cell.answered()));
  const double judged = static_cast<double>(std::max<std::uint64_t>(1, cell.judged));
  if (cell.question == bench::QueryKind::distance) {
    row.values["error_rms"] = std::sqrt(cell.error_squares / answered);
    row.values["error_max"] = cell.error_max;
  } else if (cell.question == bench::QueryKind::respond && cell.key.kind == BucketKind::volume) {
    row.values["misses"] = static_cast<double>(cell.missed);
    if (cell.judged > 0) {
      row.values["volume_error_mean"] = cell.error_sum / judged;
      row.values["volume_error_max"] = cell.error_max;
    }
  } else if (cell.question == bench::QueryKind::respond) {
    row.values["phantoms"] = static_cast<double>(cell.phantoms);
    if (cell.phantoms > 0 && !scale) return;
    row.values["phantom_force_mean"] =
        cell.phantom_sum / static_cast<double>(std::max<std::uint64_t>(1, cell.phantoms)) / scale.value_or(1.0);
    row.values["phantom_force_max"] = cell.phantom_max / scale.value_or(1.0);
  }
}

Json row_of(const SurveyIdentity& identity, const SurveyCell& cell, std::optional<double> scale) {
  const std::string query(to_string(cell.question));
  std::string bucket = cell.key.name();
  bucket.at(bucket.find('/')) = ':';
  results::Row row{.name = fmt::format("{}/algorithm:{}/pair:{}/{}", query, identity.algorithm, identity.pair, bucket),
                   .fields = fields_of(identity, query)};
  row.fields.bucket = cell.key;
  row.fields.order = "random";
  row.fields.cache = "warm";
  row.fields.configurations = cell.asked;
  row.label = "single queries by wall clock";
  if (cell.answered() == 0) {
    row.error = "no configuration has an answer";
  } else {
    const double mean = cell.sum_ns / static_cast<double>(cell.answered());
    row.values = {{results::k_processor_mean, mean},
                  {results::k_wall_mean, mean},
                  {"max_ns", cell.max_ns},
                  {"max_least_ns", cell.max_least_ns},
                  {"configurations", static_cast<double>(cell.asked)},
                  {"reachable", static_cast<double>(cell.reachable)},
                  {"failed", static_cast<double>(cell.failed)},
                  {"judged", static_cast<double>(cell.judged)},
                  {"mismatch", static_cast<double>(cell.wrong)}};
    add_errors(row, cell, scale);
  }
  Json json = results::to_json_object(row);
  const results::Outliers outliers{
      .a = identity.a, .b = identity.b, .command = identity.command, .poses = cell.poses, .responses = {}};
  json["outliers"] = results::to_json_object(outliers);
  return json;
}

Json prepare_row_of(const SurveyShard& shard) {
  const SurveyIdentity& identity = shard.identity;
  results::Row row{.name = fmt::format("prepare/algorithm:{}/pair:{}", identity.algorithm, identity.pair),
                   .fields = fields_of(identity, "prepare"),
                   .values = {{results::k_processor_mean, shard.prepare_ns},
                              {results::k_wall_mean, shard.prepare_ns},
                              {"bytes", shard.bytes}},
                   .label = "structures may have come from the cache"};
  for (const auto& [name, value] : shard.counts) {
    if (find_metric(name) != nullptr) row.values[name] = value;
  }
  return results::to_json_object(row);
}

/// How many tests, by algorithm.
Json summary_of(const Whole& whole) {
  std::uint64_t tests = 0, asked = 0, failed = 0, wrong = 0;
  double seconds = 0.0;
  for (const auto& [key, cell] : whole.cells) {
    tests += cell.configurations;
    asked += cell.asked;
    failed += cell.failed;
    wrong += cell.wrong;
    seconds += cell.seconds;
  }
  return {{"algorithm", whole.first.identity.algorithm},
          {"settings", whole.first.identity.settings},
          {"tests", tests},
          {"asked", asked},
          {"failed", failed},
          {"wrong", wrong},
          {"shards", whole.first.identity.shards},
          {"seconds", seconds}};
}

}  // namespace

void write_shard(const std::filesystem::path& file, const SurveyShard& shard) {
  Json json{{k_format_key, k_format},         {"identity", nlohmann::json(shard.identity)},
            {"number", shard.number},         {"context", shard.context},
            {"prepare_ns", shard.prepare_ns}, {"bytes", shard.bytes},
            {"counts", shard.counts},         {"cells", Json::array()}};
  for (const SurveyCell& cell : shard.cells) json["cells"].push_back(to_json_object(cell));
  write_file_atomically(file, json_text(json) + "\n");
}

SurveyShard read_shard(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw BadFile(file.string(), "cannot be opened");
  std::ostringstream text;
  text << in.rdbuf();
  const Json json = results::parse_document(text.str(), file.string());
  if (!json.is_object() || json.value(k_format_key, 0) != k_format) {
    throw BadFile(file.string(), "is no shard of sixdof survey, or of another version");
  }
  try {
    SurveyShard shard{.identity = nlohmann::json(json.at("identity")).get<SurveyIdentity>(),
                      .number = json.at("number").get<std::size_t>(),
                      .context = json.at("context"),
                      .prepare_ns = json.at("prepare_ns").get<double>(),
                      .bytes = json.at("bytes").get<double>(),
                      .counts = {},
                      .cells = {}};
    json.at("counts").get_to(shard.counts);
    for (const Json& cell : json.at("cells")) shard.cells.push_back(cell_of(cell));
    return shard;
  } catch (const nlohmann::json::exception& e) {
    throw BadFile(file.string(), results::words_of(e));
  } catch (const BadFile&) {
    throw;
  } catch (const Error& e) {
    throw BadFile(file.string(), e.what());
  }
}

bool has_shard(const std::filesystem::path& file, const SurveyIdentity& identity, std::size_t number) {
  if (!std::filesystem::exists(file)) return false;
  const SurveyShard shard = read_shard(file);
  return shard.identity == identity && shard.number == number;
}

nlohmann::ordered_json survey_document(const std::vector<std::filesystem::path>& files) {
  std::vector<Whole> wholes;  // by algorithm, in the order of the files
  for (const std::filesystem::path& file : files) {
    const SurveyShard shard = read_shard(file);
    auto whole = std::ranges::find(wholes, shard.identity.algorithm,
                                   [](const Whole& each) { return each.first.identity.algorithm; });
    if (whole == wholes.end()) {
      if (!wholes.empty() && wholes.front().first.identity.set != shard.identity.set) {
        throw BadFile(file.string(),
                      "is of another configuration set than " + wholes.front().files.begin()->second.string());
      }
      whole = wholes.insert(wholes.end(), Whole{.first = shard});
    }
    add_shard(*whole, shard, file);
  }
  if (wholes.empty()) throw BadArgument("no shard is given");
  Json document{{"context", wholes.front().first.context}, {"benchmarks", Json::array()}};
  Json algorithms = Json::array();
  for (const Whole& whole : wholes) {
    require_whole(whole);
    document["benchmarks"].push_back(prepare_row_of(whole.first));
    const std::optional<double> scale = force_scale(whole);
    for (const auto& [key, cell] : whole.cells) {
      document["benchmarks"].push_back(row_of(whole.first.identity, cell, scale));
    }
    algorithms.push_back(summary_of(whole));
  }
  const SurveyIdentity& identity = wholes.front().first.identity;
  document["survey"] = {
      {"pair", identity.pair}, {"set", identity.set}, {"grid", identity.grid}, {"algorithms", std::move(algorithms)}};
  return document;
}

}  // namespace sixdof::study
