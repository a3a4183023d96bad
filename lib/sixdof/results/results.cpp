#include <sixdof/results/results.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/results/result_json.h>

namespace sixdof::results {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(HardCase, family, algorithm, verdict, metric, words, reproduction, unit,
                                                settings, cases, worst)

namespace {

using Json = nlohmann::ordered_json;

/// Of a scene that was played. 0 where there is none.
double number_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : 0.0;
}

std::string as_text(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

void take_rows(const Json& document, Source source, Results& results) {
  if (document.contains("context") && document.at("context").is_object()) {
    for (const auto& [key, value] : document.at("context").items()) {
      if (key != "checksum") source.context.emplace_back(key, as_text(value));  // of the file, not of the run
    }
  }
  source.kind = "rows";
  const std::size_t file = results.files.size();
  std::vector<Row> rows;
  std::map<std::string, std::string> settings;  // by name: all repetitions of a row have the same
  std::size_t index = 0;
  for (const Json& entry : document.at("benchmarks")) {
    std::string place = fmt::format("benchmarks[{}]", index++);
    if (!entry.is_object()) throw BadFile(source.path, place, "not an object");
    if (const std::string name = text_at(entry, "name"); !name.empty()) place += fmt::format(" ({})", name);
    try {
      if (text_at(entry, "run_type") == "aggregate") continue;
      Row row = parse_row(entry);
      row.file = file;
      const std::string& earlier = settings.try_emplace(row.name, row.fields.settings).first->second;
      if (row.fields.settings != earlier) {
        throw Error(fmt::format("{} has the settings {} here and {} in an earlier row", row.fields.algorithm,
                                row.fields.settings, earlier));
      }
      rows.push_back(std::move(row));
    } catch (const Error& e) {
      throw BadFile(source.path, place, e.what());
    } catch (const Json::exception& e) {
      throw BadFile(source.path, place, words_of(e));
    }
  }
  Collection collection = results.collection;
  std::vector<GrowthSeries> growth = results.growth;
  try {
    take_collection(document, file, collection);
    take_growth(document, file, growth);
  } catch (const Error& e) {
    throw BadFile(source.path, e.what());
  }
  results.collection = std::move(collection);
  results.growth = std::move(growth);
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
  const std::string scene = std::filesystem::path(path).stem().string(), algorithm = text_at(play, "algorithm");
  Row row{.name = fmt::format("scene/{}/question:{}/algorithm:{}", scene, question, algorithm),
          .fields = {.query = "scene", .algorithm = algorithm, .scenario = scene, .question = question},
          .file = file};
  if (algorithm.empty()) throw BadFile(path, "an algorithm without a name");
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
    HardCase cell = nlohmann::json(entry).get<HardCase>();
    cell.file = file;
    cell.name = text_at(entry, "case");
    if (cell.family.empty() || cell.algorithm.empty() || cell.verdict.empty()) {
      throw BadFile(source.path, place, "not a cell of sixdof stress: no family, algorithm or verdict");
    }
    cases.push_back(std::move(cell));
  }
  results.hard_cases.insert(results.hard_cases.end(), cases.begin(), cases.end());
  results.files.push_back(std::move(source));
}

}  // namespace

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

Results read_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> paths;
  std::vector<std::pair<std::string, std::filesystem::path>> dated;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".json") paths.push_back(entry.path());
  }
  if (error) throw BadFile(folder.string(), "cannot be read: " + error.message());
  std::ranges::sort(paths);
  for (const auto& path : paths) {
    Results one;
    try {
      read_results(path, one);
    } catch (const BadFile&) {
      continue;
    }
    if (!one.rows.empty()) dated.emplace_back(one.files.front().at("date"), path);
  }
  if (dated.empty()) throw BadFile(folder.string(), "has no result of sixdof-bench (*.json)");
  std::ranges::stable_sort(dated);
  Results results;
  for (const auto& [date, path] : dated) read_results(path, results);
  return results;
}

Json document_of(const Json& context, std::span<const Row> rows) {
  Json list = Json::array();
  for (const Row& row : rows) list.push_back(to_json_object(row));
  return {{"context", context}, {"benchmarks", std::move(list)}};
}

void write_rows(const std::filesystem::path& file, const Json& context, std::span<const Row> rows) {
  write_file_atomically(file, document_of(context, rows).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

bool is_red(const HardCase& cell) {
  return cell.verdict != "exact" && !cell.verdict.starts_with("within") && !cell.verdict.starts_with("declared");
}

std::string reproduction(const Row& row, const Source& source) {
  const std::string program = source.at("program");
  if (source.kind == "play") return fmt::format("sixdof scene play FILE --question {}", row.fields.question);
  const std::string& query = row.fields.query;
  if (query != "precision" && query != "equivalent") {
    const std::string words = source.at("reproduction");
    std::string command = fmt::format("{}{}{} '--benchmark_filter=^{}$'", program.empty() ? "sixdof-bench" : program,
                                      words.empty() ? "" : " ", words, row.name);
    if (const auto asked = row.value("configurations")) command += fmt::format(" --sample {:.0f}", *asked);
    if (const std::string seed = source.at("seed"); !seed.empty()) command += " --seed " + seed;
    return command;
  }
  const std::string arguments = source.at("arguments");
  return fmt::format("{} {}{}{}", program.empty() ? "sixdof" : program, arguments.starts_with(query) ? "" : query,
                     arguments.starts_with(query) ? "" : " ", arguments);
}

}  // namespace sixdof::results
