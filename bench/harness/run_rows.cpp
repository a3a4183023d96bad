#include "bench/harness/run_rows.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <regex>
#include <set>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include "bench/common/build_info.h"
#include "bench/common/interrupt.h"
#include "bench/common/progress_line.h"
#include "bench/common/run_guarded.h"
#include "bench/harness/reporter.h"
#include "bench/harness/timing.h"

namespace sixdof::bench {
namespace {

/// How many rows the filter takes. Google Benchmark searches names for the filter; a leading '-' negates it.
std::size_t count_matches(const std::vector<Row>& rows) {
  std::string filter = benchmark::GetBenchmarkFilter();
  if (filter.empty() || filter == "all") return rows.size();
  const bool negated = filter.starts_with('-');
  if (negated) filter.erase(0, 1);
  try {
    const std::regex expression(filter, std::regex::extended);
    return static_cast<std::size_t>(std::count_if(
        rows.begin(), rows.end(), [&](const Row& row) { return std::regex_search(row.name, expression) != negated; }));
  } catch (const std::regex_error& e) {
    throw BadArgument(fmt::format("--benchmark_filter={}: not a regular expression ({})", filter, e.what()));
  }
}

/// Calls rows: divides the time among them, shows progress, and turns exceptions into errors of the row.
class RowCaller {
 public:
  RowCaller(std::size_t rows, double budget_s) : rows_(rows), budget_s_(budget_s) {}

  /// Google Benchmark calls a row several times in succession.
  void call(const Row& row, benchmark::State& state) {
    InterruptGuard::check();
    if (current_ != row.name) {
      current_ = row.name;
      ++begun_;
    }
    progress_.show(begun_ - 1, rows_, row.name);
    try {
      row.run(state, row_budget_s());
    } catch (const Interrupted&) {
      throw;  // through the library, which ends the run with the rows that are finished
    } catch (const NeedsSolid& e) {
      left_out.insert(row.name);
      not_solid.insert(e.what());
      state.SkipWithError(e.what());
    } catch (const std::exception& e) {
      state.SkipWithError(e.what());
    } catch (...) {
      state.SkipWithError("an exception of unknown type was thrown");
    }
    progress_.clear();
    InterruptGuard::check();
  }

  std::set<std::string> left_out;   ///< Names of the rows that are left out because they need solids.
  std::set<std::string> not_solid;  ///< Meshes, with the reason.

 private:
  /// Equal parts of the time that is left.
  double row_budget_s() const {
    if (budget_s_ == 0.0) return std::numeric_limits<double>::infinity();
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const std::size_t left = rows_ > begun_ ? rows_ - begun_ + 1 : 1;
    return std::max(0.0, budget_s_ - elapsed) / static_cast<double>(left);
  }

  const std::size_t rows_;
  const double budget_s_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  ProgressLine progress_{"rows"};
  std::string current_;
  std::size_t begun_ = 0;
};

/// What the "context" of a result file says besides Google Benchmark's own keys.
ContextKeys context_of(const Options& options, const Resources& resources) {
  ContextKeys context = build_info();
  for (const auto& algorithm : resources.registry.all()) {
    const Traits& traits = algorithm->traits();
    context.emplace_back("algorithm:" + traits.name, traits.version);
    const std::string settings = resources.settings_of(*algorithm).to_string();
    if (!settings.empty()) context.emplace_back("settings:" + traits.name, settings);
  }
  for (auto& entry : resources.cache.hashes()) context.push_back(std::move(entry));
  context.emplace_back("seed", std::to_string(options.seed));
  context.emplace_back("sample", std::to_string(options.sample));
  context.emplace_back("budget_s", fmt::format("{}", options.budget_s));
  context.emplace_back("clock_overhead_ns", fmt::format("{:.0f}", clock_overhead_ns()));
  context.emplace_back("interrupted", InterruptGuard::requested() ? "true" : "false");
  return context;
}

void run_registered(RowCaller& caller, const FieldsByName& fields, const Options& options, const Resources& resources) {
  // Before the rows run, so that a file that cannot be written is refused at once.
  std::optional<AtomicFile> file;
  if (!options.out.empty()) file.emplace(options.out);

  const std::unique_ptr<benchmark::BenchmarkReporter> console(benchmark::CreateDefaultDisplayReporter());
  RowReporter display(options.json_on_stdout ? nullptr : console.get(), caller.left_out);
  ResultCollector collector(caller.left_out, fields);
  const InterruptGuard guard;
  try {
    benchmark::RunSpecifiedBenchmarks(&display, &collector);
  } catch (const Interrupted&) {
    collector.Finalize();  // the library skips it
  }

  if (!caller.left_out.empty()) {
    print_message("sixdof-bench", fmt::format("left out {} rows that need solids: {}", caller.left_out.size(),
                                              fmt::join(caller.not_solid, ", ")));
  }
  if (options.stats) {
    const PairCache::Counts& counts = resources.cache.counts();
    fmt::print(stderr, "stats: sets_opened={} buckets_read={} meshes_loaded={} structures_prepared={}\n",
               counts.sets_opened, counts.buckets_read, counts.meshes_loaded, counts.structures_prepared);
  }
  if (file || options.json_on_stdout) {
    const std::string document = collector.document(context_of(options, resources));
    if (options.json_on_stdout) fmt::print("{}", document);
    if (file) {
      file.reset();
      write_file_atomically(options.out, document);
    }
  }
  InterruptGuard::check();
  if (collector.failed() > 0) throw Error(fmt::format("{} rows could not be run", collector.failed()));
}

}  // namespace

void run_rows(const std::vector<Row>& rows, const Options& options, const Resources& resources) {
  const std::size_t matches = count_matches(rows);
  if (matches == 0) {
    throw BadArgument(fmt::format("--benchmark_filter={}: no row matches (--benchmark_list_tests lists them)",
                                  benchmark::GetBenchmarkFilter()));
  }
  RowCaller caller(matches, options.budget_s);
  FieldsByName fields;
  for (const Row& row : rows) {
    fields.emplace(row.name, row.fields);
    benchmark::RegisterBenchmark(row.name.c_str(), [&caller, &row](benchmark::State& state) {
      caller.call(row, state);
    })->Unit(row.unit);
  }
  if (options.list_only) {
    benchmark::RunSpecifiedBenchmarks();
  } else {
    run_registered(caller, fields, options, resources);
  }
  // They refer to local variables. If an exception passes here, nobody runs them any more.
  benchmark::ClearRegisteredBenchmarks();
}

}  // namespace sixdof::bench
