#include "bench/harness/options.h"

#include <algorithm>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "bench/cli/commands.h"

namespace sixdof::bench {
namespace {

/// Short enough for a suite of hundreds of rows; a round over the bucket is the shortest measurement anyway.
constexpr const char* k_default_min_time = "--benchmark_min_time=0.1";

bool has_flag(const std::vector<std::string>& flags, const std::string& name) {
  return std::any_of(flags.begin(), flags.end(), [&](const auto& flag) { return flag.starts_with(name); });
}

}  // namespace

int parse_options(int argc, const char* const* argv, Options& options) {
  CLI::App app("sixdof-bench: collision queries under Google Benchmark", "sixdof-bench");
  app.set_version_flag("--version", std::string("sixdof-bench ") + SIXDOF_VERSION);
  app.allow_extras();
  options.manifest = SIXDOF_FIXTURES_DIR "/manifest.json";
  std::string format = "console";
  std::string out_format = "json";
  bool no_manifest = false;
  auto* const manifest =
      app.add_option("--manifest", options.manifest, "Catalogue of configuration sets")->capture_default_str();
  app.add_flag("--no-manifest", no_manifest, "No catalogue: only the sets named by --set")->excludes(manifest);
  app.add_option("--set", options.sets, "A configuration set of your own (sixdof generate); may be repeated")
      ->check(CLI::ExistingFile);
  app.add_option("--settings", options.settings, "ALGORITHM:PARAMETER=VALUE (sixdof algorithms); may be repeated");
  app.add_option("--sample", options.sample, "Configurations per bucket, drawn by seed; 0 for all")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--budget", options.budget_s, "Seconds for all rows together: samples shrink to fit; 0 for no limit")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of samples and orders")->capture_default_str();
  app.add_flag("--stats", options.stats, "Print on stderr how many sets, buckets, meshes and structures were touched");
  app.add_option("--benchmark_out,--out", options.out, "Result file (JSON); appears whole or not at all");
  app.add_option("--benchmark_out_format", out_format)->check(CLI::IsMember({"json"}))->group("");
  app.add_option("--benchmark_format", format)->check(CLI::IsMember({"console", "json", "csv"}))->group("");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& e) {
    app.exit(e);
    fmt::print("\nGoogle Benchmark's own flags are understood too:\n");
    std::fflush(stdout);
    benchmark::PrintDefaultHelp();
    return 0;
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : cli::k_exit_usage;
  }

  if (no_manifest) options.manifest.clear();
  options.benchmark_flags = app.remaining();
  options.json_on_stdout = format == "json";
  if (format == "csv") options.benchmark_flags.emplace_back("--benchmark_format=csv");
  options.list_only = has_flag(options.benchmark_flags, "--benchmark_list_tests") &&
                      !has_flag(options.benchmark_flags, "--benchmark_list_tests=false");
  if (!has_flag(options.benchmark_flags, "--benchmark_min_time")) {
    options.benchmark_flags.emplace_back(k_default_min_time);
  }
  return -1;
}

}  // namespace sixdof::bench
