#include <cmath>
#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/stability/families.h>
#include <sixdof/stability/reference.h>

#include "exact_algorithm.h"

namespace sixdof::stability {
namespace {

std::vector<Case> all_field_cases() {
  std::vector<Case> all;
  for (const Family& family : families()) {
    if (family.field_cases == nullptr) continue;
    for (Case& member : family.field_cases()) all.push_back(std::move(member));
  }
  return all;
}

TEST(FieldCases, AreSixtyOrMoreAndNameTheirThreads) {
  std::set<std::string> names;
  for (const Case& member : all_field_cases()) {
    EXPECT_THAT(member.thread, ::testing::HasSubstr("/")) << member.name;
    EXPECT_TRUE(names.insert(member.thread + ": " + member.name).second) << member.name;
  }
  EXPECT_GE(names.size(), 60u);
}

TEST(FieldCases, TruthsAgreeWithBruteForceInLongDouble) {
  for (const Case& member : all_field_cases()) {
    for (const Shot& shot : member.shots) {
      if (std::isnan(shot.truth.distance) || shot.raw) continue;
      const auto distance = static_cast<double>(reference_distance(*shot.a, *shot.b, shot.X_AB.pose()));
      EXPECT_NEAR(distance, shot.truth.distance, shot.rounding() + shot.truth.error)
          << member.thread << ": " << member.name;
    }
  }
}

/// What the threads say, computed again there with rational arithmetic or separating axes; round bodies are inscribed,
/// so they are farther apart by what their tessellation cuts off.
TEST(FieldCases, TruthsAreThoseOfTheThreads) {
  struct Known {
    double gap, slack;
  };
  const std::map<std::string, Known> k_known{
      {"danfis/libccd#55", {std::sqrt(3.10802e-16), 1e-12}},
      {"dimforge/parry#253", {2.0373e-7, 1e-10}},
      {"jrouwe/JoltPhysics closest point", {0.961998923, 1e-8}},
      {"jrouwe/JoltPhysics small triangle against a large hull", {342.294, 1e-3}},
      {"jrouwe/JoltPhysics#1008", {1.7638e-4, 1e-3}},
      {"coal-library/coal#604", {3.57545e-6, 1e-9}},
      {"flexible-collision-library/fcl#391", {-1.5334e-7, 1e-11}},
      {"flexible-collision-library/fcl#275", {10.0, 1e-12}},
      {"flexible-collision-library/fcl#127", {3.0, 1e-12}},
      {"google-deepmind/mujoco#1473", {0.6, 1e-12}},
      {"google-deepmind/mujoco#1857", {0.035, 1e-12}},
      {"danfis/libccd#25", {-0.1, 1e-12}},
      {"google-deepmind/mujoco_warp gjk test", {-1.577288e-5, 1e-10}},
      {"gkjohnson/three-mesh-bvh#386", {1.0, 1e-12}},
  };
  std::set<std::string> seen;
  for (const Case& member : all_field_cases()) {
    const auto known = k_known.find(member.thread);
    if (known == k_known.end()) continue;
    seen.insert(member.thread);
    EXPECT_NEAR(member.shots.front().truth.gap, known->second.gap, known->second.slack) << member.thread;
  }
  EXPECT_EQ(seen.size(), k_known.size());
}

TEST(FieldCases, TheReferenceIsRight) {
  for (const Case& member : all_field_cases()) {
    const Finding worst = judge(member, exact_traits(), prepare_exact).worst();
    EXPECT_LE(worst.verdict, Verdict::unsupported)
        << member.thread << ": " << member.name << ": " << to_string(worst.verdict) << " " << worst.metric << " "
        << worst.value << ", shot " << worst.shot << ": " << worst.words;
  }
}

}  // namespace
}  // namespace sixdof::stability
