#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include <nlohmann/json.hpp>

#include "bench/harness/result_journal.h"
#include "bench/study/equivalent.h"

namespace sixdof::study {

/// What `sixdof equivalent` has measured. While it runs, every measurement is a line of FILE.journal; its result FILE
/// has them as well, so that a run that broke off, however it did, is continued without measuring anything twice.
class MeasurementStore {
 public:
  using Json = nlohmann::ordered_json;
  using Key = std::tuple<std::string, std::string, Resolution>;  ///< Scenario, algorithm, resolution.

  struct Entry {
    Measurement measured;
    double seconds = 0.0;  ///< Wall time that measuring took, with preparation.
  };

  /// Without open(), measurements are kept in memory only.
  /// @param context of this run (harness/run_context.h)
  explicit MeasurementStore(Json context);
  /// Removes a journal without measurements.
  ~MeasurementStore();
  MeasurementStore(const MeasurementStore&) = delete;
  MeasurementStore& operator=(const MeasurementStore&) = delete;

  /// Begins FILE.journal. With `resume` it takes over the measurements of FILE and of FILE.journal, if they exist.
  /// @throws BadFile if FILE could not be written, the journal of another run is there or in use, or an earlier result
  ///   cannot be read; BadArgument if it was measured on another machine, or by another build or other options
  void open(const std::filesystem::path& file, bool resume);

  /// Null if it was not measured.
  const Entry* find(const Key& key) const;
  const std::map<Key, Entry>& entries() const { return entries_; }

  /// @throws BadFile if the journal cannot be written
  void add(const Key& key, Entry entry);

  /// Of all measurements: the member "measurements" of FILE.
  Json as_json() const;

  /// Removes the journal, since FILE is whole.
  void finish();

 private:
  void take_over_file(const std::filesystem::path& file);
  void take_over_journal(const std::filesystem::path& journal);
  void require_same(const Json& context, const std::filesystem::path& from) const;
  void take(const Json& line);

  const Json context_;
  std::unique_ptr<bench::ResultJournal> journal_;
  bool journal_has_measurements_ = false;
  std::map<Key, Entry> entries_;
};

}  // namespace sixdof::study
