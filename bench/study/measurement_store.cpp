#include "bench/study/measurement_store.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include "bench/harness/run_context.h"

namespace sixdof::study {
namespace {

using Json = MeasurementStore::Json;
using Key = MeasurementStore::Key;
using Entry = MeasurementStore::Entry;

constexpr const char* k_measurements = "measurements";  ///< Key in FILE.
constexpr const char* k_measured = "measured";          ///< Key of a line of the journal.
constexpr const char* k_context = "context";

/// An eta that is not defined becomes null.
Json json_of(const Key& key, const Entry& entry) {
  const auto& [scenario, algorithm, at] = key;
  const Measurement& measured = entry.measured;
  Json counters = Json::object();
  for (const auto& [name, value] : measured.counters) counters[name] = value;
  return {{"scenario", scenario},
          {"algorithm", algorithm},
          {"at", at},
          {"time_ns", measured.time_ns},
          {"eta", measured.eta},
          {"bytes", measured.bytes},
          {"counters", std::move(counters)},
          {"seconds", entry.seconds}};
}

std::pair<Key, Entry> entry_of(const Json& json) {
  Entry entry;
  Measurement& measured = entry.measured;
  measured.at = json.at("at").get<Resolution>();
  measured.time_ns = json.at("time_ns").get<double>();
  const Json& eta = json.at("eta");
  measured.eta = eta.is_null() ? std::numeric_limits<double>::quiet_NaN() : eta.get<double>();
  measured.bytes = json.at("bytes").get<double>();
  for (const auto& [name, value] : json.at("counters").items()) {
    measured.counters.emplace_back(name, value.get<double>());
  }
  entry.seconds = json.at("seconds").get<double>();
  Key key(json.at("scenario").get<std::string>(), json.at("algorithm").get<std::string>(), measured.at);
  return {std::move(key), std::move(entry)};
}

}  // namespace

MeasurementStore::MeasurementStore(Json context) : context_(std::move(context)) {}

MeasurementStore::~MeasurementStore() {
  if (journal_ && !journal_has_measurements_) journal_->remove();
}

void MeasurementStore::open(const std::filesystem::path& file, bool resume) {
  remove_stale_partials(file);
  check_writable(file);
  const std::filesystem::path journal = file.string() + ".journal";
  journal_ = std::make_unique<bench::ResultJournal>(journal);
  journal_has_measurements_ =
      std::ranges::any_of(journal_->lines(), [](const Json& line) { return line.contains(k_measured); });
  if (journal_has_measurements_ && !resume) {
    throw BadFile(journal.string(),
                  "holds the measurements of a run that was broken off; --resume continues it, removing the journal "
                  "gives them up");
  }
  if (!journal_has_measurements_) journal_->clear();
  if (resume) {
    // The journal of a run that was to replace FILE does not belong to it.
    const bool replaces = journal_has_measurements_ && !journal_->lines().front().value("continues", true);
    if (!replaces && std::filesystem::exists(file)) take_over_file(file);
    take_over_journal(journal);
  }
  journal_->append({{k_context, context_}, {"continues", resume}});
}

void MeasurementStore::take_over_file(const std::filesystem::path& file) {
  try {
    std::ifstream in(file, std::ios::binary);
    const Json document = Json::parse(in);
    require_same(document.at(k_context), file);
    for (const Json& line : document.at(k_measurements)) take(line);
  } catch (const Json::exception& e) {
    throw BadFile(file.string(),
                  fmt::format("cannot be continued, it is no result of sixdof equivalent: {}", e.what()));
  }
}

void MeasurementStore::take_over_journal(const std::filesystem::path& journal) {
  std::size_t number = 0;
  for (const Json& line : journal_->lines()) {
    ++number;
    try {
      if (line.contains(k_context)) require_same(line.at(k_context), journal);
      if (line.contains(k_measured)) take(line.at(k_measured));
    } catch (const Json::exception& e) {
      throw BadFile(journal.string(), fmt::format("line {}", number), e.what());
    }
  }
}

void MeasurementStore::require_same(const Json& context, const std::filesystem::path& from) const {
  const std::string difference = bench::difference_of_contexts(context, context_);
  if (!difference.empty()) throw BadArgument(fmt::format("{}: cannot be continued: {}", from.string(), difference));
}

void MeasurementStore::take(const Json& line) {
  auto [key, entry] = entry_of(line);
  entries_.insert_or_assign(std::move(key), std::move(entry));
}

const MeasurementStore::Entry* MeasurementStore::find(const Key& key) const {
  const auto found = entries_.find(key);
  return found == entries_.end() ? nullptr : &found->second;
}

void MeasurementStore::add(const Key& key, Entry entry) {
  if (journal_) {
    Json line = Json::object();
    line[k_measured] = json_of(key, entry);
    journal_->append(line);
    journal_has_measurements_ = true;
  }
  entries_.insert_or_assign(key, std::move(entry));
}

MeasurementStore::Json MeasurementStore::as_json() const {
  Json list = Json::array();
  for (const auto& [key, entry] : entries_) list.push_back(json_of(key, entry));
  return list;
}

void MeasurementStore::finish() {
  if (!journal_) return;
  journal_->remove();
  journal_.reset();
}

}  // namespace sixdof::study
