#include <sixdof/report/results.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/measure/metrics.h>
#include <sixdof/report/result_json.h>

namespace sixdof::report {
namespace {

using Json = nlohmann::ordered_json;

double number_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : 0.0;
}

std::string as_text(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

/// {"voxel_size": 0.004, "culling": "on"} -> "voxel_size=0.004,culling=on".
std::string settings_text(const Json& fields) {
  const auto found = fields.find("settings");
  if (found == fields.end() || !found->is_object()) return text_at(fields, "settings");
  std::string text;
  for (const auto& [key, value] : found->items()) {
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", key, as_text(value));
  }
  return text;
}

void take_fields(const Json& fields, Row& row) {
  if (!fields.is_object()) throw Error("\"sixdof\" is no object");
  row.query = text_at(fields, "query");
  row.algorithm = text_at(fields, "algorithm");
  if (row.query.empty() || row.algorithm.empty()) throw Error("\"sixdof\" names no query or no algorithm");
  row.settings = settings_text(fields);
  row.pair = text_at(fields, "pair");
  row.order = text_at(fields, "order");
  row.body = text_at(fields, "body");
  row.cache = text_at(fields, "cache");
  row.scenario = text_at(fields, "scenario");
  row.question = text_at(fields, "question");
  const auto bucket = fields.find("bucket");
  if (bucket == fields.end()) return;
  if (!bucket->is_object() || !bucket->contains("percent") || !bucket->at("percent").is_number()) {
    throw Error("\"sixdof.bucket\" has no number \"percent\"");
  }
  row.kind = text_at(*bucket, "kind");
  row.percent = bucket->at("percent").get<double>();
}

/// Means and their bounds in ns, under names that say so.
void take_values(const Json& entry, Row& row) {
  for (const auto& [key, value] : entry.items()) {
    if (value.is_number() && find_metric(key) != nullptr) row.values[key] = value.get<double>();
  }
  for (const auto& [key, name] : {std::pair("cpu_time", k_processor_mean), std::pair("real_time", k_wall_mean)}) {
    if (!row.values.contains(key)) throw Error(fmt::format("no number \"{}\"", key));
    const double unit = nanoseconds(text_at(entry, "time_unit"));
    for (const char* const suffix : {"", "_low", "_high"}) {
      const auto found = row.values.find(std::string(key) + suffix);
      if (found == row.values.end()) continue;
      row.values[std::string(name) + suffix] = found->second * unit;
      row.values.erase(found);
    }
  }
}

Row row_of(const Json& entry, std::size_t file) {
  if (!entry.contains("sixdof")) throw Error("no \"sixdof\" object: not a row of sixdof-bench; measure again");
  Row row;
  row.file = file;
  row.name = text_at(entry, "name");
  row.label = text_at(entry, "label");
  take_fields(entry.at("sixdof"), row);
  if (entry.contains("error_occurred") && entry.at("error_occurred") == true) {
    row.error = text_at(entry, "error_message");
    if (row.error.empty()) row.error = "unknown error";
  } else {
    take_values(entry, row);
  }
  if (entry.contains("outliers")) row.outliers = parse_outliers(entry.at("outliers"));
  return row;
}

void take_rows(const Json& document, Source source, Results& results) {
  if (document.contains("context") && document.at("context").is_object()) {
    for (const auto& [key, value] : document.at("context").items()) {
      if (key != "checksum") source.context.emplace_back(key, as_text(value));  // of the file, not of the run
    }
  }
  source.kind = "rows";
  const std::size_t file = results.files.size();
  std::vector<Row> rows;
  std::size_t index = 0;
  for (const Json& entry : document.at("benchmarks")) {
    std::string place = fmt::format("benchmarks[{}]", index++);
    if (!entry.is_object()) throw BadFile(source.path, place, "not an object");
    if (const std::string name = text_at(entry, "name"); !name.empty()) place += fmt::format(" ({})", name);
    try {
      if (text_at(entry, "run_type") != "aggregate") rows.push_back(row_of(entry, file));
    } catch (const Error& e) {
      throw BadFile(source.path, place, e.what());
    }
  }
  Collection collection = results.collection;
  try {
    take_collection(document, file, collection);
  } catch (const Error& e) {
    throw BadFile(source.path, e.what());
  }
  results.collection = std::move(collection);
  results.rows.insert(results.rows.end(), rows.begin(), rows.end());
  results.files.push_back(std::move(source));
}

/// What `sixdof scene play --json` says of one algorithm, as the row that sixdof-bench has of a scene.
Row played_row(const Json& play, const std::string& question, const std::string& path, std::size_t file) {
  constexpr std::pair<const char*, const char*> k_times[] = {{"processor_us", "processor_ns"},
                                                             {"processor_us", k_processor_mean},
                                                             {"mean_us", k_wall_mean},
                                                             {"p99_us", "p99_frame_ns"},
                                                             {"max_us", "max_ns"},
                                                             {"first_us", "first_frame_ns"}};
  constexpr std::pair<const char*, const char*> k_counts[] = {
      {"missed", "missed_pairs"}, {"wrong", "wrong_pairs"}, {"false_per_true", "false_per_true"}, {"bytes", "bytes"}};
  Row row{.file = file, .query = "scene", .algorithm = text_at(play, "algorithm"), .question = question};
  row.scenario = std::filesystem::path(path).stem().string();
  row.name = fmt::format("scene/{}/question:{}/algorithm:{}", row.scenario, question, row.algorithm);
  if (row.algorithm.empty()) throw BadFile(path, "an algorithm without a name");
  for (const auto& [key, name] : k_times) row.values[name] = 1e3 * number_at(play, key);
  for (const auto& [key, name] : k_counts) row.values[name] = number_at(play, key);
  if (row.count("missed_pairs") + row.count("wrong_pairs") > 0.0) {
    row.error = fmt::format("{} missed, {} wrong", row.count("missed_pairs"), row.count("wrong_pairs"));
  }
  return row;
}

void take_plays(const Json& document, Source source, Results& results) {
  source.kind = "play";
  std::vector<Row> rows;
  for (const Json& part : document) {
    if (!part.is_object() || !part.contains("algorithms") || !part.at("algorithms").is_array()) {
      throw BadFile(source.path, "a question without algorithms");
    }
    for (const Json& play : part.at("algorithms")) {
      if (!play.is_object()) throw BadFile(source.path, "an algorithm that is no object");
      rows.push_back(played_row(play, text_at(part, "question"), source.path, results.files.size()));
    }
  }
  results.rows.insert(results.rows.end(), rows.begin(), rows.end());
  results.files.push_back(std::move(source));
}

void take_hard_cases(const Json& document, Source source, Results& results) {
  source.kind = "stress";
  const std::size_t file = results.files.size();
  std::vector<HardCase> cases;
  std::size_t index = 0;
  for (const Json& entry : document) {
    const std::string place = fmt::format("[{}]", index++);
    if (!entry.is_object()) throw BadFile(source.path, place, "not an object");
    HardCase cell{.file = file,
                  .family = text_at(entry, "family"),
                  .algorithm = text_at(entry, "algorithm"),
                  .verdict = text_at(entry, "verdict"),
                  .metric = text_at(entry, "metric"),
                  .name = text_at(entry, "case"),
                  .words = text_at(entry, "words"),
                  .reproduction = text_at(entry, "reproduction"),
                  .unit = text_at(entry, "unit"),
                  .settings = text_at(entry, "settings"),
                  .cases = number_at(entry, "cases"),
                  .worst = number_at(entry, "worst")};
    if (cell.family.empty() || cell.algorithm.empty() || cell.verdict.empty()) {
      throw BadFile(source.path, place, "not a cell of sixdof stress: no family, algorithm or verdict");
    }
    cases.push_back(std::move(cell));
  }
  results.hard_cases.insert(results.hard_cases.end(), cases.begin(), cases.end());
  results.files.push_back(std::move(source));
}

}  // namespace

std::optional<double> Row::value(const std::string& key) const {
  const auto found = values.find(key);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

std::string Source::at(const std::string& key) const {
  const auto found = std::ranges::find(context, key, &std::pair<std::string, std::string>::first);
  return found == context.end() ? std::string() : found->second;
}

void parse_results(const std::string& text, const std::string& path, Results& results) {
  const Json document = parse_document(text, path);
  Source source{.path = visible_text(path, k_any_length), .kind = {}, .context = {}};
  try {
    if (document.is_object() && document.contains("benchmarks") && document.at("benchmarks").is_array()) {
      return take_rows(document, std::move(source), results);
    }
    if (document.is_array() && !document.empty() && document[0].is_object() && document[0].contains("question")) {
      return take_plays(document, std::move(source), results);
    }
    if (document.is_array() && !document.empty()) return take_hard_cases(document, std::move(source), results);
  } catch (const Json::exception& e) {
    throw BadFile(path, words_of(e));
  }
  throw BadFile(path,
                "neither a result of sixdof-bench or a study (an object with the array \"benchmarks\") nor of sixdof "
                "stress (an array of cells) or sixdof scene play --json");
}

void read_results(const std::filesystem::path& path, Results& results) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw BadFile(path.string(), "cannot be opened");
  std::ostringstream text;
  text << in.rdbuf();
  if (in.bad()) throw BadFile(path.string(), "cannot be read");
  parse_results(text.str(), path.string(), results);
}

std::vector<Fault> faults_of(const Row& row) {
  if (!row.error.empty()) return {{.what = row.query == "scene" ? row.error : "not run: " + row.error, .counter = {}}};
  std::vector<Fault> faults;
  const double asked = row.count("configurations");
  if (row.count("failed") > 0.0) faults.push_back({"failed", "failed", row.count("failed"), asked});
  if (row.count("mismatch") > 0.0) faults.push_back({"wrong", "mismatch", row.count("mismatch"), row.count("judged")});
  if (row.query == "respond" && row.count("misses") > 0.0) {
    faults.push_back({"without a force", "misses", row.count("misses"), asked});
  }
  return faults;
}

bool is_red(const HardCase& cell) {
  return cell.verdict != "exact" && !cell.verdict.starts_with("within") && !cell.verdict.starts_with("declared");
}

std::string to_string(const Fault& fault) {
  if (fault.count == 0.0) return fault.what;
  return fault.of > 0.0 ? fmt::format("{:.0f} of {:.0f} {}", fault.count, fault.of, fault.what)
                        : fmt::format("{:.0f} {}", fault.count, fault.what);
}

std::string reproduction(const Row& row, const Source& source) {
  if (source.kind == "play") return fmt::format("sixdof scene play FILE --question {}", row.question);
  if (row.query != "precision" && row.query != "equivalent") {
    std::string command = fmt::format("sixdof-bench '--benchmark_filter=^{}$'", row.name);
    if (const auto asked = row.value("configurations")) command += fmt::format(" --sample {:.0f}", *asked);
    if (const std::string seed = source.at("seed"); !seed.empty()) command += " --seed " + seed;
    return command;
  }
  return fmt::format("sixdof {} {}", row.query, source.at("arguments"));
}

}  // namespace sixdof::report
