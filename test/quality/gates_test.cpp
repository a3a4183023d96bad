#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

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
      if (name == bound.measure) return value;
    }
  } else if (const auto value = measured(bound, r.recording)) {
    return *value;
  }
  ADD_FAILURE() << bound.measure << " is undefined here";
  return 0.0;
}

std::vector<Bound> held() {
  std::vector<Bound> list;
  std::ranges::copy_if(bounds(), std::back_inserter(list), [](const Bound& b) { return b.kind != Kind::weakness; });
  return list;
}

class Gate : public ::testing::TestWithParam<Bound> {};

TEST_P(Gate, Holds) {
  const Bound& bound = GetParam();
  const double value = measured(bound);
  EXPECT_TRUE(holds(bound, value)) << fmt::format(
      "{} of {} on {} by law {}: measured {:.4g}; {} bound {:g} in test/quality/*bounds.cpp ({})", bound.measure,
      bound.algorithm, bound.scenario, to_string(bound.law), value, to_string(bound.kind), bound.bound, bound.reason);
}

INSTANTIATE_TEST_SUITE_P(Gates, Gate, ::testing::ValuesIn(held()), [](const auto& made) {
  const Bound& bound = made.param;
  return test_name({bound.scenario, bound.algorithm, to_string(bound.law), bound.measure, to_string(bound.kind)});
});

/// A depth that is read from voxels is off by half a voxel at most, and so is a sum of depths over points.
class Resolution : public ::testing::TestWithParam<Bound> {};

TEST_P(Resolution, MagnitudeIsWithinHalfAVoxel) {
  const Bound& bound = GetParam();
  const Recorded& r = recorded(std::string(bound.scenario), std::string(bound.algorithm));
  double depth = 0.0;
  for (const double progress : r.recording.progress) {
    if (const auto ideal = r.scenario->ideal(IdealLaw::depth, progress)) depth = std::max(depth, ideal->penalty);
  }
  const double half_voxel = 0.5 * r.settings.number("voxel_size") * r.scenario->a().diagonal();
  EXPECT_LE(measured(bound), half_voxel / depth);
}

std::vector<Bound> voxels() {
  std::vector<Bound> list;
  for (const Bound& bound : held()) {
    const bool by_voxels = bound.algorithm == "vps" || bound.algorithm == "vps-field";
    // The plate of Ib is thinner than a voxel.
    if (by_voxels && bound.measure == (bound.scenario == "III" ? "sigma_T" : "sigma_F") &&
        bound.kind == Kind::characterised && bound.scenario != "Ib")
      list.push_back(bound);
  }
  return list;
}

INSTANTIATE_TEST_SUITE_P(Gates, Resolution, ::testing::ValuesIn(voxels()), [](const auto& made) {
  return test_name({made.param.scenario, made.param.algorithm, made.param.measure});
});

}  // namespace
}  // namespace sixdof
