#include <sixdof/stability/families.h>

#include <cmath>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/stability/reference.h>

#include "exact_algorithm.h"

namespace sixdof::stability {
namespace {

constexpr std::size_t k_samples = 6;

Case sample(const Family& family, std::size_t index, std::uint64_t seed = 11) {
  const Genes genes = sample_genes(family, seed, index, k_samples);
  Draw draw(genes);
  return family.make(draw);
}

TEST(Families, AreTwentyThreeWithNamesOfTheirOwn) {
  std::set<std::string> names;
  int number = 0;
  for (const Family& family : families()) {
    EXPECT_EQ(family.number, ++number);
    names.insert(std::string(family.name));
    EXPECT_EQ(&find_family(family.name), &family);
  }
  EXPECT_EQ(names.size(), 23u);
  try {
    find_family("scales");
    FAIL();
  } catch (const BadArgument& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("there are scale, size-ratio"));
  }
}

TEST(Families, GiveTheSameCasesForOneSeed) {
  for (const Family& family : families()) {
    const Case one = sample(family, 2), two = sample(family, 2), other = sample(family, 2, 12);
    ASSERT_FALSE(one.shots.empty()) << family.name;
    for (std::size_t i = 0; i < one.shots.size(); ++i) {
      EXPECT_EQ(one.shots[i].a->hash(), two.shots[i].a->hash()) << family.name;
      EXPECT_EQ(one.shots[i].X_AB.t, two.shots[i].X_AB.t) << family.name;
      EXPECT_EQ(one.shots[i].X_AB.q.coeffs(), two.shots[i].X_AB.q.coeffs()) << family.name;
    }
    EXPECT_NE(one.parameter, other.parameter) << family.name;
  }
}

TEST(Families, SweepTheirParameterFromEndToEnd) {
  for (const Family& family : families()) {
    if (family.name == "bad-pose" || family.name == "kissing" || family.name == "grazing") continue;  // signed, or 0
    double least = INFINITY, greatest = -INFINITY;
    for (std::size_t i = 0; i < k_samples; ++i) {
      const double parameter = sample(family, i).parameter;
      least = std::min(least, parameter);
      greatest = std::max(greatest, parameter);
    }
    EXPECT_GT(greatest, 1.5 * least) << family.name;
  }
}

TEST(Families, TruthsAgreeWithBruteForceInLongDouble) {
  std::size_t compared = 0;
  for (const Family& family : families()) {
    if (family.name == "holes") continue;  // a truth of the bodies before they are damaged
    for (std::size_t i = 0; i < k_samples; ++i) {
      const Case member = sample(family, i);
      for (const Shot& shot : member.shots) {
        if (std::isnan(shot.truth.distance) || shot.raw) continue;
        if (shot.a->triangles().size() * shot.b->triangles().size() > 40000) continue;
        const auto distance = static_cast<double>(reference_distance(*shot.a, *shot.b, shot.X_AB.pose()));
        ++compared;
        EXPECT_NEAR(distance, shot.truth.distance, shot.rounding() + shot.truth.error)
            << family.name << " " << i << ": " << member.name << " at " << member.parameter;
      }
    }
  }
  EXPECT_GT(compared, 150u);
}

TEST(Families, TheReferenceHasNoRedCell) {
  for (const Family& family : families()) {
    for (std::size_t i = 0; i < k_samples; ++i) {
      const Case member = sample(family, i);
      const Finding worst = judge(member, exact_traits(), prepare_exact).worst();
      EXPECT_LE(worst.verdict, Verdict::unsupported)
          << family.name << " " << i << ": " << member.name << " at " << member.parameter << ": "
          << to_string(worst.verdict) << " " << worst.metric << " " << worst.value << " " << worst.unit << ", shot "
          << worst.shot << ": " << worst.words;
    }
  }
}

}  // namespace
}  // namespace sixdof::stability
