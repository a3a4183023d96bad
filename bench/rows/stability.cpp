#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <sixdof/stability/families.h>
#include <sixdof/stability/judge.h>
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

using namespace stability;

constexpr std::size_t k_samples = 4;

/// Those of the command line, if they are not the defaults: hundreds of bodies are prepared.
Settings row_settings(const Resources& resources, const Algorithm& algorithm) {
  const Settings& given = resources.settings_of(algorithm);
  return given.to_string() == algorithm.settings().to_string() ? coarse_settings(algorithm) : given;
}

/// Cases, worst findings and the time to ask them all, preparation included.
void run(const Resources& resources, const Algorithm& algorithm, const Family& family, benchmark::State& state) {
  const Settings settings = row_settings(resources, algorithm);
  const Prepare prepare = [&](const Mesh& a, const Mesh& b) { return algorithm.prepare(a, b, settings); };
  std::vector<Case> cases;
  for (std::size_t i = 0; i < k_samples; ++i) {
    const Genes genes = sample_genes(family, resources.seed, i, k_samples);
    Draw draw(genes);
    cases.push_back(family.make(draw));
  }
  Finding worst;
  std::size_t red = 0;
  for (auto _ : state) {
    worst = {};
    red = 0;
    for (const Case& member : cases) {
      const Finding found = judge(member, algorithm.traits(), prepare).worst();
      if (is_red(found.verdict)) ++red;
      if (found.worse_than(worst)) worst = found;
    }
  }
  state.counters["stability_cases"] = static_cast<double>(cases.size());
  state.counters["stability_red"] = static_cast<double>(red);
  state.counters["stability_verdict"] = static_cast<double>(worst.verdict);
  state.counters["stability_worst"] = worst.value;
  state.SetLabel(fmt::format("{}: {} in {}", to_string(worst.verdict), worst.metric, worst.unit));
}

}  // namespace

std::vector<Row> stability_rows(const Resources& resources) {
  std::vector<Row> rows;
  for (const auto& algorithm : resources.registry.all()) {
    // What is known of a case is about the meshes.
    if (!algorithm->traits().timed || algorithm->traits().body != Body::mesh) continue;
    for (const Family& family : families()) {
      rows.push_back({.name = fmt::format("stability/{}/algorithm:{}", family.name, algorithm->traits().name),
                      .run = [&resources, &algorithm = *algorithm, &family](
                                 benchmark::State& state, const Share&) { run(resources, algorithm, family, state); },
                      .fields = {.query = "stability",
                                 .algorithm = algorithm->traits().name,
                                 .settings = row_settings(resources, *algorithm).to_string()}});
    }
  }
  return rows;
}

}  // namespace sixdof::bench
