#include "bench/harness/run_rows.h"

#include <cstdio>
#include <exception>
#include <functional>
#include <mutex>
#include <regex>
#include <set>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/library_build.h>
#include <sixdof/oracle/solid.h>
#include <sixdof/results/fault.h>
#include "bench/common/interrupt.h"
#include "bench/common/run_guarded.h"
#include "bench/harness/reporter.h"
#include "bench/harness/result_store.h"
#include "bench/harness/result_text.h"
#include "bench/harness/row_caller.h"
#include "bench/harness/run_context.h"

namespace sixdof::bench {
namespace {

constexpr const char* k_program = "sixdof-bench";
/// A filter for Google Benchmark: choose_rows() has applied the user's.
constexpr const char* k_all_registered = ".";

/// The rows that the filter takes. Google Benchmark searches names for the filter; a leading '-' negates it.
std::vector<const PlannedRow*> choose_rows(const std::vector<PlannedRow>& rows) {
  std::string filter = benchmark::GetBenchmarkFilter();
  if (filter.empty() || filter == "all") filter = ".";
  const bool negated = filter.starts_with('-');
  if (negated) filter.erase(0, 1);
  std::vector<const PlannedRow*> chosen;
  try {
    const std::regex expression(filter, std::regex::extended);
    for (const PlannedRow& row : rows) {
      if (std::regex_search(row.name, expression) != negated) chosen.push_back(&row);
    }
  } catch (const std::regex_error& e) {
    throw BadArgument(fmt::format("--benchmark_filter={}: not a regular expression ({})", filter, e.what()));
  }
  if (chosen.empty()) {
    throw BadArgument(fmt::format("--benchmark_filter={}: no row matches (--benchmark_list_tests lists them)",
                                  benchmark::GetBenchmarkFilter()));
  }
  return chosen;
}

/// Registers rows with Google Benchmark while it exists. The library keeps references to them. It adds words to
/// names, which RowReporter removes.
class Registration {
 public:
  /// @param iterations of every row, queries; 0 for as many as Google Benchmark finds fit
  Registration(const std::vector<const PlannedRow*>& rows, std::size_t iterations,
               const std::function<void(const PlannedRow&, benchmark::State&)>& call) {
    for (const PlannedRow* const row : rows) {
      auto* const registered =
          benchmark::RegisterBenchmark(row->name.c_str(), [row, &call](benchmark::State& state) { call(*row, state); });
      registered->Unit(row->unit);
      registered->MeasureProcessCPUTime();  // a query may use several threads
      if (const auto fixed = row->one_round ? 1 : static_cast<std::int64_t>(iterations); fixed > 0) {
        registered->Iterations(fixed);
      }
      if (row->one_round || row->manual_time) registered->UseManualTime();
    }
  }
  ~Registration() { benchmark::ClearRegisteredBenchmarks(); }
  Registration(const Registration&) = delete;
  Registration& operator=(const Registration&) = delete;
};

void list_rows(const std::vector<const PlannedRow*>& rows) {
  for (const PlannedRow* const row : rows) fmt::print("{}\n", row->name);
}

/// Writes the result once, whichever thread comes first.
class Delivery {
 public:
  Delivery(const Options& options, ResultStore& store) : options_(options), store_(store) {}

  void deliver(bool interrupted) {
    std::call_once(once_, [&] {
      store_.finish(interrupted);
      if (!options_.format) return;
      fmt::print("{}", result_text(store_.document(interrupted), *options_.format));
      std::fflush(stdout);
    });
  }

 private:
  const Options& options_;
  ResultStore& store_;
  std::once_flag once_;
};

void print_left_out(const RowCaller& caller) {
  if (caller.left_out.empty()) return;
  print_message(k_program, fmt::format("left out {} rows that need solids: {}{}", caller.left_out.size(),
                                       fmt::join(caller.not_solid, ", "), k_repair_hint));
}

/// Checks the meshes that rows used, after the result is written: the first check of a large mesh takes seconds.
void print_warnings(const PairCache& cache) {
  if (InterruptGuard::requested()) return;
  for (const std::string& line : cache.warnings()) print_message(k_program, line);
}

void print_stats(const RowCaller& caller, const PairCache::Counts& counts) {
  fmt::print(stderr, "stats: sets_opened={} buckets_read={} meshes_loaded={} structures_prepared={} rows_measured={}\n",
             counts.sets_opened, counts.buckets_read, counts.meshes_loaded, counts.structures_prepared,
             caller.measured());
}

/// Measures rows and writes the result. @returns how many could not be run
int measure(const std::vector<const PlannedRow*>& rows, const Options& options, const Resources& resources,
            ResultStore& store) {
  FieldsByName fields;
  OutliersByName outliers;
  for (const PlannedRow* const row : rows) {
    fields.emplace(row->name, row->fields);
    if (row->outliers) outliers.emplace(row->name, row->outliers);
  }
  const auto commit = [&] { store.commit(resources.cache.hashes()); };
  SamplePlan plan(rows);
  for (const results::RowFields& measured : store.fields()) plan.keep(measured);
  RowCaller caller(rows.size(), options.budget_s, plan, commit);
  Console console;
  RowReporter display(options.format ? nullptr : &console, caller.left_out);
  ResultCollector collector(store, fields, outliers);
  RowReporter result(&collector, caller.left_out);
  const std::function<void(const PlannedRow&, benchmark::State&)> call =
      [&](const PlannedRow& row, benchmark::State& state) { caller.call(row, state); };
  Delivery delivery(options, store);
  const InterruptGuard guard(k_program, [&delivery]() noexcept {
    try {
      delivery.deliver(true);
    } catch (const std::exception& e) {
      print_message(k_program, e.what());
    }
  });
  try {
    const Registration registered(rows, options.iterations, call);
    if (!rows.empty()) benchmark::RunSpecifiedBenchmarks(&display, &result, k_all_registered);
  } catch (const Interrupted&) {
  }
  commit();
  print_left_out(caller);
  if (options.stats) print_stats(caller, resources.cache.counts());
  delivery.deliver(InterruptGuard::requested());
  print_warnings(resources.cache);
  InterruptGuard::check();
  return result.failed();
}

/// @throws DefectsFound if a row has answers that are missing, or wrong though its algorithm promises right ones
void require_right_answers(const nlohmann::ordered_json& document) {
  std::vector<std::string> wrong;
  for (const auto& entry : document.at("benchmarks")) {
    if (entry.value("run_type", "iteration") != "iteration") continue;
    const results::Row row = results::parse_row(entry);
    if (row.fields.algorithm == "null") continue;  // answers with constants, by design
    std::vector<results::Fault> faults = results::own_faults(row);
    if (row.fields.approximates) {
      std::erase_if(faults, [](const results::Fault& f) { return f.counter == "mismatch" || f.counter == "misses"; });
    }
    if (!faults.empty()) wrong.push_back(row.name + ": " + results::to_string(faults));
  }
  if (wrong.empty()) return;
  throw DefectsFound(fmt::format("{} rows have wrong or missing answers, the first {}", wrong.size(), wrong.front()));
}

void warn_of_build() {
  if (library_build() != LibraryBuild::unoptimised) return;
  print_message(k_program,
                "***WARNING*** sixdof was built without optimisation, so times mean nothing; build with "
                "-DCMAKE_BUILD_TYPE=Release");
}

}  // namespace

void run_rows(const std::vector<PlannedRow>& rows, const Options& options, const Resources& resources) {
  std::vector<const PlannedRow*> chosen = choose_rows(rows);
  if (options.list_only) return list_rows(chosen);
  warn_of_build();
  std::vector<std::string> order;
  std::set<std::string> algorithms;
  for (const PlannedRow* const row : chosen) {
    order.push_back(row->name);
    algorithms.insert(row->fields.algorithm);
  }
  // Another rival that is set up must not keep a run from being continued.
  const auto is_asked = [&](const Traits& traits) { return !traits.is_rival() || algorithms.contains(traits.name); };
  ResultStore store(std::move(order), run_context(options, resources.registry, resources.settings, is_asked));
  if (!options.out.empty()) store.open(options.out, options.out_format, options.resume);
  if (const auto there = std::erase_if(chosen, [&](const PlannedRow* row) { return store.has(row->name); });
      there > 0) {
    print_message(k_program, fmt::format("{}: {} rows are finished, {} will be measured", options.out.string(), there,
                                         chosen.size()));
  }
  if (const int failed = measure(chosen, options, resources, store); failed > 0) {
    throw Error(fmt::format("{} rows could not be run", failed));
  }
  if (options.fail_on_wrong) require_right_answers(store.document(false));
}

}  // namespace sixdof::bench
