#include <memory>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "bench/harness/timing.h"
#include "bench/rows/families.h"

namespace sixdof::bench {
namespace {

void run(const Resources& resources, const Algorithm& algorithm, const CatalogueEntry& pair, benchmark::State& state) {
  const Settings& settings = resources.settings_of(algorithm);
  const Mesh& a = resources.cache.mesh(pair.a);
  const Mesh& b = resources.cache.mesh(pair.b);
  std::unique_ptr<Query> query;
  double processor_ns = 0.0;  // of those in other processes
  std::size_t prepared_there = 0;
  for ([[maybe_unused]] auto _ : state) {
    if (query) {
      // The time to destroy the last structure is not part of preparing the next one.
      state.PauseTiming();
      query.reset();
      state.ResumeTiming();
    }
    auto [prepared, took_ns] = with_clock([&] { return resources.cache.prepare(algorithm, settings, a, b); });
    query = std::move(prepared);
    if (const RemoteQuery* const remote = as_remote(*query)) {
      state.SetIterationTime(1e-9 * remote->prepared().wall_ns.value_or(took_ns));
      processor_ns += remote->prepared().cpu_ns.value_or(took_ns);
      state.counters[k_processor_inside] = processor_ns / static_cast<double>(++prepared_there);
    }
  }
  const Footprint footprint = query->footprint();
  state.counters["bytes"] = static_cast<double>(footprint.bytes);
  for (const auto& [name, count] : footprint.counts) state.counters[name] = count;
  state.SetLabel(settings.to_string());
}

}  // namespace

std::vector<PlannedRow> prepare_rows(const Resources& resources) {
  std::vector<PlannedRow> rows;
  for (const CatalogueEntry& pair : resources.catalogue.sets()) {
    for (const auto& algorithm : resources.registry.all()) {
      if (!algorithm->traits().timed) continue;
      rows.push_back({.name = fmt::format("prepare/algorithm:{}/pair:{}", algorithm->traits().name, pair.pair),
                      .run = [&resources, &algorithm = *algorithm, &pair](
                                 benchmark::State& state, const Share&) { run(resources, algorithm, pair, state); },
                      .fields = {.query = "prepare",
                                 .algorithm = algorithm->traits().name,
                                 .settings = resources.settings_of(*algorithm).to_string(),
                                 .pair = pair.pair,
                                 .runtime = algorithm->traits().runtime,
                                 .isolated = is_isolated(*algorithm)},
                      .unit = benchmark::kMillisecond,
                      .manual_time = is_isolated(*algorithm)});
    }
  }
  return rows;
}

}  // namespace sixdof::bench
