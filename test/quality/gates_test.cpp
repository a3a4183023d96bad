#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "recorded.h"

namespace sixdof {
namespace {

double measured(const Bound& bound) {
  const Recorded& r = recorded(std::string(bound.scenario), std::string(bound.algorithm));
  EXPECT_EQ(r.recording.first_failure, "");
  if (bound.measure.starts_with("jump")) {
    for (const auto& [name, value] : evaluate_jumps(*r.scenario, *r.query, r.recording, bound.law)) {
      if (name == bound.measure) return std::abs(value);
    }
  } else if (const auto value = measured(bound, r.recording)) {
    return std::abs(*value);
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
      ADD_FAILURE() << what << ": not the value recorded in test/quality/bounds.cpp";
  }
}

INSTANTIATE_TEST_SUITE_P(Gates, Gate, ::testing::ValuesIn(bounds().begin(), bounds().end()), [](const auto& made) {
  return test_name({made.param.scenario, made.param.algorithm, to_string(made.param.law), made.param.measure});
});

}  // namespace
}  // namespace sixdof
