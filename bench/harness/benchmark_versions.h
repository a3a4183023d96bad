#pragma once

#include <cctype>
#include <string>
#include <utility>

/// What version 1.8 of Google Benchmark changed. Templates on its type of a row's result, so that only the members of
/// the version at hand are compiled.
namespace sixdof::bench {

/// Whether a row says by `skipped` and `skip_message` why it has no result (1.8 and later), or by `error_occurred` and
/// `error_message` (1.7). @tparam Run benchmark::BenchmarkReporter::Run
template <class Run>
concept HasSkipped = requires(Run run) {
  run.skipped;
  run.skip_message;
};

/// Whether the row has an error instead of a result.
template <class Run>
bool has_error(const Run& run) {
  if constexpr (HasSkipped<Run>) {
    using Skipped = decltype(Run::skipped);
    return run.skipped == Skipped::SkippedWithError;
  } else {
    return run.error_occurred;
  }
}

/// Makes the row one with an error.
template <class Run>
void set_error(Run& run, std::string message) {
  if constexpr (HasSkipped<Run>) {
    using Skipped = decltype(Run::skipped);
    run.skipped = Skipped::SkippedWithError;
    run.skip_message = std::move(message);
  } else {
    run.error_occurred = true;
    run.error_message = std::move(message);
  }
}

/// A flag of the command line as that version takes it: the seconds of --benchmark_min_time end in "s" from 1.8 on, and
/// are a bare number in 1.7. Both spellings are accepted here; other flags stay as they are.
template <class Run>
std::string flag_of_version(std::string flag) {
  if (!flag.starts_with("--benchmark_min_time=")) return flag;
  if constexpr (HasSkipped<Run>) {
    if (std::isdigit(static_cast<unsigned char>(flag.back())) != 0) flag += 's';
  } else {
    if (flag.ends_with('s')) flag.pop_back();
  }
  return flag;
}

}  // namespace sixdof::bench
