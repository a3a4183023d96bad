// The program sixdof-bench: every algorithm of this build and every Registrar, every family of rows.

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <sixdof/configuration/set_catalogue.h>
#include "bench/common/all_algorithms.h"
#include "bench/common/interrupt.h"
#include "bench/common/program_end.h"
#include "bench/common/run_guarded.h"
#include "bench/common/serve_algorithm.h"
#include "bench/harness/options.h"
#include "bench/harness/own_sets.h"
#include "bench/harness/run_rows.h"
#include "bench/harness/suite.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

/// Rows on cold caches take seconds each, and those of motions matter to algorithms that keep something from query to
/// query. Without a suite that lists them they are taken where the filter has these words.
constexpr const char* k_cold = "cold";
constexpr const char* k_motion = "motion";
/// So are rows of scenes, where it begins with this one.
constexpr const char* k_scene = "scene/";

void run(const Options& options) {
  Registry registry;
  const std::vector<std::string> external = register_all_algorithms(registry, options.process);
  auto settings = parse_parameters(options.parameters, registry);
  SetCatalogue catalogue;
  if (!options.manifest.empty()) catalogue = SetCatalogue::read(options.manifest);
  PairCache cache(options.sample, options.seed,
                  [&](const std::string& key) { return load_mesh_of(key, options, catalogue); });
  const auto coarse_set = [&] {
    const InterruptGuard interruptible(options.program);
    return add_own_sets(options, catalogue, cache);
  }();
  const Resources resources{.registry = registry,
                            .catalogue = catalogue,
                            .settings = std::move(settings),
                            .cache = cache,
                            .seed = options.seed};

  std::vector<PlannedRow> rows;
  for (const auto family : {prepare_rows, query_rows, scenario_rows, scene_rows, generate_rows}) {
    std::ranges::move(family(resources), std::back_inserter(rows));
  }
  if (!options.suite.empty()) {
    std::vector<std::string> named_only;
    for (const auto& algorithm : registry.all()) {
      if (!algorithm->traits().in_default_runs()) named_only.push_back(algorithm->traits().name);
    }
    const Suite suite = read_suite(options.suite, external, named_only);
    std::erase_if(rows, [&](const PlannedRow& row) { return !suite(row.name); });
    const std::size_t sample = options.sample > 0 ? options.sample : Share().configurations;
    for (PlannedRow& row : rows) {
      if (const std::size_t most = *suite(row.name); most < sample) row.fields.sample_limit = most;
    }
  } else {
    const std::string filter = benchmark::GetBenchmarkFilter();
    const auto is_named = [&](const char* word) { return filter.find(word) != std::string::npos; };
    std::erase_if(rows, [&](const PlannedRow& row) {
      return (row.fields.cache == k_cold && !is_named(k_cold)) ||
             (row.fields.order == k_motion && !is_named(k_motion)) ||
             (row.name.starts_with(k_scene) && !is_named(k_scene));
    });
  }
  run_rows(rows, options, resources);
}

}  // namespace
}  // namespace sixdof::bench

int main(int argc, char** argv) {
  if (const auto code = sixdof::serve_if_asked(argc, argv)) return *code;
  int usage = 0;
  const int code = sixdof::run_guarded("sixdof-bench", [&] {
    sixdof::bench::Options options;
    usage = sixdof::bench::parse_options(argc, argv, options);
    if (usage < 0) sixdof::bench::run(options);
  });
  sixdof::print_cache_refusal("sixdof-bench");
  return code != 0 ? code : std::max(usage, 0);
}
