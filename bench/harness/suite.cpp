#include "bench/harness/suite.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include "bench/cli/interrupt.h"

namespace sixdof::bench {

Suite::Suite(const Options& options, const Registry& registry, const SetCatalogue& catalogue)
    : options_(options), registry_(registry), catalogue_(catalogue), stock_(options.sample, options.seed) {
  for (const auto& algorithm : registry.all()) settings_.emplace(algorithm->traits().name, algorithm->settings());
  for (const std::string& text : options.settings) {
    const auto colon = text.find(':');
    if (colon == std::string::npos) throw BadArgument(fmt::format("{}: must read ALGORITHM:PARAMETER=VALUE", text));
    const Algorithm& algorithm = registry.find(text.substr(0, colon));
    settings_.at(algorithm.traits().name).set_all({text.substr(colon + 1)});
  }
}

benchmark::internal::Benchmark* Suite::add(const std::string& name, Row row) {
  names_.push_back(name);
  return benchmark::RegisterBenchmark(
      name.c_str(), [this, name, row = std::move(row)](benchmark::State& state) { run(name, row, state); });
}

void Suite::run(const std::string& name, const Row& row, benchmark::State& state) {
  InterruptGuard::check();
  if (current_ != name) {
    current_ = name;
    ++begun_;
    if (progress_) progress_->begin(name);
  }
  try {
    row(state);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& e) {
    state.SkipWithError(e.what());
  }
  if (progress_) progress_->wipe();
  InterruptGuard::check();
}

void Suite::expect_rows(std::size_t count) {
  expected_ = count;
  progress_ = std::make_unique<Progress>(count);
  start_ = std::chrono::steady_clock::now();
}

double Suite::row_budget_s() const {
  if (options_.budget_s == 0.0) return std::numeric_limits<double>::infinity();
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::size_t left = expected_ > begun_ ? expected_ - begun_ + 1 : 1;
  return std::max(0.0, options_.budget_s - elapsed) / static_cast<double>(left);
}

}  // namespace sixdof::bench
