#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sixdof/scenario/evaluation.h>
#include "bench/common/all_algorithms.h"

#include "bounds.h"

namespace sixdof {
namespace {

/// An algorithm prepared and recorded once per scenario, for all bounds of this process.
struct Recorded {
  std::unique_ptr<Scenario> scenario;
  std::unique_ptr<Query> query;
  Recording recording;
};

const Recorded& recorded(const std::string& scenario, const std::string& algorithm) {
  static std::map<std::pair<std::string, std::string>, Recorded> cache;
  const auto [entry, is_new] = cache.try_emplace({scenario, algorithm});
  Recorded& r = entry->second;
  if (is_new) {
    Registry registry;
    register_all_algorithms(registry);
    const auto& [name, parameters] = subject(algorithm);
    const Algorithm& found = registry.find(name);
    Settings settings = found.settings();
    settings.set_all(parameters);
    r.scenario = make_scenario(scenario);
    r.query = found.prepare(r.scenario->a(), r.scenario->b(), settings);
    r.recording = record(*r.scenario, *r.query, k_gate_steps);
  }
  return r;
}

double measured(const Bound& bound) {
  const Recorded& r = recorded(std::string(bound.scenario), std::string(bound.algorithm));
  EXPECT_EQ(r.recording.first_failure, "");
  Measures measures = evaluate(*r.scenario, r.recording, bound.law);
  if (bound.measure.starts_with("jump")) measures = evaluate_jumps(*r.scenario, *r.query, r.recording, bound.law);
  for (const auto& [name, value] : measures) {
    if (name == bound.measure) return std::abs(value);
  }
  ADD_FAILURE() << bound.measure << " is undefined here";
  return 0.0;
}

class Gate : public ::testing::TestWithParam<Bound> {};

TEST_P(Gate, Holds) {
  const Bound& bound = GetParam();
  const double value = measured(bound);
  const std::string what =
      fmt::format("{} of {} on {} by law {}: measured {:.4g}, bound {:g} ({})", bound.measure, bound.algorithm,
                  bound.scenario, to_string(bound.law), value, bound.bound, bound.reason);
  switch (judge(value, bound.bound, bound.kind)) {
    case Verdict::holds:
      break;
    case Verdict::worse:
      ADD_FAILURE() << what << ": worse than the table allows";
      break;
    case Verdict::too_loose:
      ADD_FAILURE() << what << ": below half of the bound, tighten test/quality/bounds.cpp";
      break;
    case Verdict::changed:
      ADD_FAILURE() << what << ": not the value in test/quality/bounds.cpp; if it is better now, make it a gate";
  }
}

std::string name_of(const ::testing::TestParamInfo<Bound>& info) {
  const Bound& b = info.param;
  std::string name = fmt::format("{}_{}_{}_{}", b.scenario, b.algorithm, to_string(b.law), b.measure);
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Gates, Gate, ::testing::ValuesIn(bounds().begin(), bounds().end()), name_of);

}  // namespace
}  // namespace sixdof
