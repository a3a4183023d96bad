// The program sixdof-bench: every algorithm of this build and every Registrar, every family of rows.

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/configuration/set_catalogue.h>
#include "bench/common/all_algorithms.h"
#include "bench/common/interrupt.h"
#include "bench/common/program_end.h"
#include "bench/common/rivals.h"
#include "bench/common/run_guarded.h"
#include "bench/common/serve_algorithm.h"
#include "bench/harness/options.h"
#include "bench/harness/own_sets.h"
#include "bench/harness/run_rows.h"
#include "bench/harness/suite.h"
#include "bench/harness/variants.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

/// Rows on cold caches take seconds each, and those of motions matter to algorithms that keep something from query to
/// query. Without a suite that lists them they are taken where the filter has these words.
constexpr const char* k_cold = "cold";
constexpr const char* k_motion = "motion";
/// So are rows of scenes, where it has one of these.
constexpr const char* k_scene = "scene/";
constexpr const char* k_deform = "deform/";

/// Where `name` stands in `text` without being a part of a longer name; npos if it does not.
std::size_t find_name(const std::string& text, const std::string& name) {
  const auto is_of_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
  };
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const bool begins = at == 0 || !is_of_name(text[at - 1]);
    if (begins && (at + name.size() == text.size() || !is_of_name(text[at + name.size()]))) return at;
  }
  return std::string::npos;
}

bool has_name(const std::string& text, const std::string& name) { return find_name(text, name) != std::string::npos; }

/// Puts the names of the rivals into the filter where it says k_rivals.
void name_rivals_in_filter(const Registry& registry) {
  std::string filter = benchmark::GetBenchmarkFilter();
  const std::size_t at = find_name(filter, k_rivals);
  if (at == std::string::npos) return;
  if (filter.starts_with('-') && rival_names(registry).empty()) return;  // all rows but theirs
  const std::vector<std::string> names = with_rivals({k_rivals}, registry);
  filter.replace(at, std::string_view(k_rivals).size(), fmt::format("({})", fmt::join(names, "|")));
  benchmark::SetBenchmarkFilter(filter);
}

/// Whether the filter means a rival. Without that a run does not depend on what is set up.
bool asks_for(const std::string& filter, const std::string& rival) {
  return filter.find("algorithm:") != std::string::npos || has_name(filter, rival);
}

/// Says which algorithms the filter names that have rows, but none in the suite.
void say_what_the_suite_lacks(const Options& options, const std::vector<PlannedRow>& rows, const Suite& suite) {
  const std::string filter = benchmark::GetBenchmarkFilter();
  std::map<std::string, bool> in_suite;
  for (const PlannedRow& row : rows) {
    if (has_name(filter, row.fields.algorithm)) in_suite[row.fields.algorithm] |= suite(row.name).has_value();
  }
  for (const auto& [algorithm, is_there] : in_suite) {
    if (is_there) continue;
    print_message(options.program, fmt::format("{} has no rows in the suite {}; --suite all has them", algorithm,
                                               options.suite.filename().string()));
  }
}

void run(const Options& options) {
  Registry registry;
  const std::vector<std::string> external = register_all_algorithms(registry, options.process, options.program);
  name_rivals_in_filter(registry);
  const std::string filter = benchmark::GetBenchmarkFilter();
  const std::vector<VariantRequest> of_suite =
      options.suite.empty() ? std::vector<VariantRequest>() : suite_variants(options.suite);
  const std::vector<std::string> parameters = register_variants(options.parameters, of_suite, registry);
  auto settings = parse_parameters(parameters, registry);
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
                            .assignments = parse_assignments(parameters, registry),
                            .cache = cache,
                            .seed = options.seed};

  std::vector<PlannedRow> rows;
  for (const auto family : {prepare_rows, query_rows, cast_rows, contact_rows, depth_rows, scenario_rows, scene_rows,
                            deform_rows, generate_rows}) {
    std::ranges::move(family(resources), std::back_inserter(rows));
  }
  if (!options.suite.empty()) {
    std::vector<std::string> named_only;
    for (const auto& algorithm : registry.all()) {
      const Traits& traits = algorithm->traits();
      // The suite for two meshes of the user's lists all algorithms, and these need no list that names them.
      const bool is_named = options.own_pair() && traits.is_rival() && has_name(filter, traits.name);
      if (!traits.in_default_runs() && !is_named) named_only.push_back(traits.name);
    }
    const Suite suite = read_suite(options.suite, external, named_only, rival_names(registry));
    say_what_the_suite_lacks(options, rows, suite);
    std::erase_if(rows, [&](const PlannedRow& row) { return !suite(row.name); });
    const std::size_t sample = options.sample > 0 ? options.sample : Share().configurations;
    for (PlannedRow& row : rows) {
      if (const std::size_t most = *suite(row.name); most < sample) row.fields.sample_limit = most;
    }
  } else {
    const auto is_named = [&](const char* word) { return filter.find(word) != std::string::npos; };
    std::set<std::string> left_out;
    for (const std::string& rival : rival_names(registry)) {
      if (!asks_for(filter, rival)) left_out.insert(rival);
    }
    std::erase_if(rows, [&](const PlannedRow& row) {
      return left_out.contains(row.fields.algorithm) || (row.fields.cache == k_cold && !is_named(k_cold)) ||
             (row.fields.order == k_motion && !is_named(k_motion)) ||
             (row.name.starts_with(k_scene) && !is_named(k_scene)) ||
             (row.name.starts_with(k_deform) && !is_named(k_deform));
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
