#include "bench/harness/result_store.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include "bench/harness/result_checksums.h"
#include "bench/harness/result_text.h"
#include "bench/harness/run_context.h"

namespace sixdof::bench {
namespace {

using Json = ResultStore::Json;

std::filesystem::path journal_of(const std::filesystem::path& file) { return file.string() + ".journal"; }

bool failed(const std::vector<Json>& runs) {
  return std::ranges::any_of(runs, [](const Json& run) { return run.value("error_occurred", false); });
}

}  // namespace

ResultStore::ResultStore(std::vector<std::string> order, Json context)
    : order_(std::move(order)), context_(std::move(context)) {}

ResultStore::~ResultStore() {
  if (journal_ && !journal_has_rows_) journal_->remove();
}

void ResultStore::open(const std::filesystem::path& file, ResultFormat format, bool resume) {
  namespace fs = std::filesystem;
  if (fs::exists(file) && !fs::is_regular_file(file)) {
    throw BadFile(file.string(), "cannot be written: is not a regular file");
  }
  remove_stale_partials(file);
  check_writable(file);
  file_ = file;
  format_ = format;
  journal_ = std::make_unique<ResultJournal>(journal_of(file));
  journal_has_rows_ = std::ranges::any_of(journal_->lines(), [](const Json& line) { return line.contains("row"); });
  if (journal_has_rows_ && !resume) {
    throw BadFile(journal_of(file).string(),
                  fmt::format("holds the rows of a run that was broken off; --resume {} continues it, removing the "
                              "journal gives them up",
                              file.string()));
  }
  if (!journal_has_rows_) journal_->clear();
  if (resume) {
    // The journal of a run that was to replace FILE does not belong to it.
    const bool replaces = journal_has_rows_ && !journal_->lines().front().value("continues", true);
    if (format == ResultFormat::json && !replaces && fs::exists(file)) take_over_file();
    take_over_journal();
  }
  journal_->append({{"context", context_}, {"continues", resume}});
}

void ResultStore::take_over_file() {
  Json document;
  try {
    std::ostringstream text;
    text << std::ifstream(file_, std::ios::binary).rdbuf();
    document = Json::parse(text.view());
    take_checksums(document, file_, text.view());
    take_over(document.at("context"), file_);
    std::vector<std::pair<std::string, Runs>> rows;
    for (Json& run : document.at("benchmarks")) {
      const std::string name = run.at("run_name");
      if (rows.empty() || rows.back().first != name) rows.emplace_back(name, Runs());
      rows.back().second.push_back(std::move(run));
    }
    for (auto& [name, runs] : rows) keep(name, std::move(runs));
  } catch (const Json::exception& e) {
    throw BadFile(file_.string(), fmt::format("cannot be continued, it is no result of sixdof-bench: {}", e.what()));
  }
}

void ResultStore::take_over_journal() {
  const std::filesystem::path journal = journal_of(file_);
  std::size_t number = 0;
  for (const Json& line : journal_->lines()) {
    ++number;
    try {
      if (line.contains("context")) {
        take_over(line.at("context"), journal);
      } else {
        keep(line.at("row"), line.at("runs").get<Runs>());
        context_.update(line.at("hashes"));
      }
    } catch (const Json::exception& e) {
      throw BadFile(journal.string(), fmt::format("line {}", number), e.what());
    }
  }
}

void ResultStore::take_over(const Json& context, const std::filesystem::path& from) {
  const std::string difference = difference_of_contexts(context, context_);
  if (!difference.empty()) {
    throw BadArgument(fmt::format("{}: cannot be continued: {}", from.string(), difference));
  }
  for (const auto& [key, value] : context.items()) {
    if (is_hash(key)) context_[key] = value;
  }
}

void ResultStore::keep(const std::string& row, Runs runs) {
  if (!rows_.contains(row)) names_.push_back(row);
  rows_[row] = std::move(runs);
}

bool ResultStore::has(const std::string& row) const {
  const std::scoped_lock lock(mutex_);
  const auto found = rows_.find(row);
  return found != rows_.end() && !failed(found->second);
}

std::vector<results::RowFields> ResultStore::fields() const {
  const std::scoped_lock lock(mutex_);
  std::vector<results::RowFields> list;
  for (const auto& [name, runs] : rows_) {
    if (failed(runs) || runs.empty() || !runs.front().contains(results::k_row_fields_key)) continue;
    list.push_back(results::row_fields_of(runs.front().at(results::k_row_fields_key)));
  }
  return list;
}

void ResultStore::add(const std::string& row, Json run) {
  measuring_ = row;
  measured_.push_back(std::move(run));
}

void ResultStore::commit(const std::vector<std::pair<std::string, std::string>>& hashes) {
  if (measured_.empty()) return;
  Json used = Json::object();
  for (const auto& [key, value] : hashes) used[key] = value;
  const std::scoped_lock lock(mutex_);
  if (const std::string difference = difference_of_hashes(context_, used); !difference.empty()) {
    throw BadArgument(fmt::format("{}: cannot be continued: {}", file_.string(), difference));
  }
  if (journal_) {
    journal_->append({{"row", measuring_}, {"runs", measured_}, {"hashes", used}});
    journal_has_rows_ = true;
  }
  context_.update(used);
  keep(measuring_, std::move(measured_));
  measured_.clear();
}

Json ResultStore::document(bool interrupted) const {
  const std::scoped_lock lock(mutex_);
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < order_.size(); ++i) places.emplace(order_[i], i);
  std::vector<std::string> names = names_;
  std::ranges::stable_sort(names, {}, [&](const std::string& name) {
    const auto found = places.find(name);
    return found == places.end() ? order_.size() : found->second;
  });
  Json document;
  document["context"] = context_;
  document["context"]["interrupted"] = interrupted ? "true" : "false";
  document["benchmarks"] = Json::array();
  std::size_t family = 0;
  for (const std::string& name : names) {
    for (Json run : rows_.at(name)) {
      // Google Benchmark counts the rows of one run.
      run["family_index"] = family;
      document["benchmarks"].push_back(std::move(run));
    }
    ++family;
  }
  return document;
}

void ResultStore::finish(bool interrupted) {
  if (file_.empty()) return;
  try {
    write_file_atomically(file_, result_text(document(interrupted), format_));
  } catch (const BadFile& e) {
    throw Error(fmt::format("{}; the rows are in {}, and --resume {} writes the file without measuring them again",
                            e.what(), journal_of(file_).string(), file_.string()));
  }
  if (interrupted && format_ == ResultFormat::csv) return;  // only the journal can be continued
  journal_->remove();
}

}  // namespace sixdof::bench
