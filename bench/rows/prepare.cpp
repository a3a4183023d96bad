#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

void run(Suite& suite, const Algorithm& algorithm, const CatalogueEntry& pair, benchmark::State& state) {
  const Settings& settings = suite.settings(algorithm);
  const Mesh& a = suite.stock().mesh(pair.a);
  const Mesh& b = suite.stock().mesh(pair.b);
  std::unique_ptr<Query> query;
  for ([[maybe_unused]] auto _ : state) {
    if (query) {
      // Taking the last structure apart is no part of building one.
      state.PauseTiming();
      query.reset();
      state.ResumeTiming();
    }
    query = suite.stock().prepare(algorithm, settings, a, b);
    benchmark::DoNotOptimize(query.get());
  }
  const Footprint footprint = query->footprint();
  state.counters["bytes"] = static_cast<double>(footprint.bytes);
  for (const auto& [name, count] : footprint.counts) state.counters[name] = count;
  state.SetLabel(settings.to_string());
}

}  // namespace

void add_prepare_rows(Suite& suite) {
  for (const CatalogueEntry& pair : suite.catalogue().sets()) {
    for (const auto& algorithm : suite.registry().all()) {
      if (!algorithm->traits().timed) continue;
      const auto name = fmt::format("prepare/algorithm:{}/pair:{}", algorithm->traits().name, pair.pair);
      auto* const row = suite.add(name, [&suite, &algorithm = *algorithm, &pair](benchmark::State& state) {
        run(suite, algorithm, pair, state);
      });
      row->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace sixdof::bench
