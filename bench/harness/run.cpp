#include "bench/harness/run.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <regex>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include "bench/algorithms.h"
#include "bench/cli/commands.h"
#include "bench/cli/interrupt.h"
#include "bench/harness/build_info.h"
#include "bench/harness/options.h"
#include <sixdof/query/registrar.h>
#include "bench/harness/reporter.h"
#include "bench/harness/suite.h"
#include "bench/harness/timing.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

using Context = std::vector<std::pair<std::string, std::string>>;

/// Hands what is left of the command line to Google Benchmark. @throws BadArgument for what it does not know either
void initialize_benchmark(const Options& options) {
  // The library keeps a pointer to the program's name.
  static std::vector<std::string> words;
  words = {"sixdof-bench"};
  words.insert(words.end(), options.benchmark_flags.begin(), options.benchmark_flags.end());
  // The library insists on a file name before it calls a file reporter; ours keeps the text to itself.
  words.emplace_back("--benchmark_out=/dev/null");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int count = static_cast<int>(words.size());
  benchmark::Initialize(&count, pointers.data());
  if (count > 1) throw BadArgument(fmt::format("{}: no such option (--help lists them)", pointers[1]));
}

/// How many of the names the filter takes, as the library decides it: a search, negated by a leading '-'.
std::size_t count_matches(const std::vector<std::string>& names) {
  std::string filter = benchmark::GetBenchmarkFilter();
  if (filter.empty() || filter == "all") return names.size();
  const bool negated = filter.starts_with('-');
  if (negated) filter.erase(0, 1);
  try {
    const std::regex expression(filter, std::regex::extended);
    return static_cast<std::size_t>(std::count_if(names.begin(), names.end(), [&](const std::string& name) {
      return std::regex_search(name, expression) != negated;
    }));
  } catch (const std::regex_error& e) {
    throw BadArgument(fmt::format("--benchmark_filter={}: not a regular expression ({})", filter, e.what()));
  }
}

Context context_of(const Suite& suite, Stock& stock) {
  Context context = build_info();
  for (const auto& algorithm : suite.registry().all()) {
    const Traits& traits = algorithm->traits();
    context.emplace_back("algorithm:" + traits.name, traits.version);
    const std::string settings = suite.settings(*algorithm).to_string();
    if (!settings.empty()) context.emplace_back("settings:" + traits.name, settings);
  }
  for (auto& entry : stock.hashes()) context.push_back(std::move(entry));
  context.emplace_back("seed", std::to_string(suite.options().seed));
  context.emplace_back("sample", std::to_string(suite.options().sample));
  context.emplace_back("budget_s", fmt::format("{}", suite.options().budget_s));
  context.emplace_back("clock_overhead_ns", fmt::format("{:.0f}", clock_overhead_ns()));
  context.emplace_back("interrupted", InterruptGuard::requested() ? "true" : "false");
  return context;
}

/// Swallows what the console would show.
class Silence final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}
};

void print_stats(const Stock::Counts& counts) {
  fmt::print(stderr, "stats: sets_opened={} buckets_read={} meshes_loaded={} structures_prepared={}\n",
             counts.sets_opened, counts.buckets_read, counts.meshes_loaded, counts.structures_prepared);
}

void run_rows(Suite& suite, std::size_t matches) {
  // Opened first: that a file cannot be written should not be found out after ten minutes.
  std::optional<AtomicFile> file;
  if (!suite.options().out.empty()) file.emplace(suite.options().out);

  ResultCollector collector;
  Silence silence;
  std::unique_ptr<benchmark::BenchmarkReporter> console(benchmark::CreateDefaultDisplayReporter());
  const bool quiet = suite.options().json_on_stdout;
  suite.expect_rows(matches);
  const InterruptGuard guard;
  try {
    benchmark::RunSpecifiedBenchmarks(quiet ? &silence : console.get(), &collector);
  } catch (const Interrupted&) {
    collector.Finalize();  // The library did not come to it.
  }

  if (suite.options().stats) print_stats(suite.stock().counts());
  if (file || quiet) {
    const std::string document = collector.document(context_of(suite, suite.stock()));
    if (quiet) fmt::print("{}", document);
    if (file) {
      file.reset();
      write_file_atomically(suite.options().out, document);
    }
  }
  InterruptGuard::check();
  if (collector.failed() > 0) throw Error(fmt::format("{} rows could not be run", collector.failed()));
}

}  // namespace

int run(int argc, const char* const* argv) {
  Options options;
  if (const int code = parse_options(argc, argv, options); code >= 0) return code;
  if (cli::run_guarded("sixdof-bench", [&] { initialize_benchmark(options); }) != 0) return cli::k_exit_usage;
  return cli::run_guarded("sixdof-bench", [&] {
    Registry registry;
    register_all_algorithms(registry);
    for (const auto& maker : Registrar::makers()) registry.add(maker());
    SetCatalogue catalogue;
    if (!options.manifest.empty()) catalogue = SetCatalogue::read(options.manifest);
    for (const auto& set : options.sets) catalogue.add_file(set);

    Suite suite(options, registry, catalogue);
    add_all_rows(suite);
    const std::size_t matches = count_matches(suite.names());
    if (matches == 0) {
      throw BadArgument(fmt::format("--benchmark_filter={}: no benchmark matches (--benchmark_list_tests lists them)",
                                    benchmark::GetBenchmarkFilter()));
    }
    if (options.list_only) {
      benchmark::RunSpecifiedBenchmarks();
    } else {
      run_rows(suite, matches);
    }
    // The rows refer to the suite, which ends here.
    benchmark::ClearRegisteredBenchmarks();
  });
}

}  // namespace sixdof::bench
