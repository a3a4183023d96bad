#include <sixdof/configuration/verification.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include <sixdof/generation/distance_generator.h>

#include "shapes.h"

namespace sixdof {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

const std::unique_ptr<Algorithm> k_brute_force = make_brute_force_algorithm();

// Two walls and a box: the target is met from outside at the outer wall, and again between the walls. Rays beside the
// walls meet nothing.
const Mesh k_a = test::boxes_mesh({{{1.1, 0.3, 0}, {0.05, 0.3, 0.3}}, {{-0.9, 0.3, 0}, {0.05, 0.3, 0.3}}}, "walls");
const Mesh k_b = test::boxes_mesh({{{5.0, 1.0, 2.0}, {0.1, 0.12, 0.14}}}, "box");
const Grid k_grid = make_grid("90");
const std::vector<double> k_percents{0, 2, 10};

using Edit = std::function<void(std::vector<Bucket>&)>;

/// Generates, edits, writes and verifies.
Verdict verify_after(const Edit& edit, std::size_t sample = 200) {
  static const Generated honest = generate_distances(*make_sphere_method(*k_brute_force), k_a, k_b, k_grid, k_percents);
  std::vector<Bucket> buckets = honest.buckets;
  edit(buckets);
  const auto path = std::filesystem::path(testing::TempDir()) /
                    (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
                     std::to_string(::getpid()) + "_verify.h5");
  ConfigurationSetWriter writer(
      path, {.generator_version = "0", .a = MeshIdentity::of(k_a), .b = MeshIdentity::of(k_b), .grid = k_grid});
  for (const Bucket& bucket : buckets) writer.write(bucket.summary, bucket.translations);
  writer.commit();
  const ConfigurationSet set(path);
  const Verdict verdict = verify_set(set, k_a, k_b, *k_brute_force, {.size = sample, .seed = 5});
  std::filesystem::remove(path);
  return verdict;
}

/// Applies f to all rows, so that repeated rotations stay equal.
void for_all(Bucket& bucket, const std::function<double(double)>& f) {
  for (double& s : bucket.translations) s = f(s);
}

TEST(Verification, FindsNothingWrongWithAnHonestSet) {
  const Verdict verdict = verify_after([](auto&) {});
  EXPECT_THAT(verdict.problems, IsEmpty());
  ASSERT_EQ(verdict.buckets.size(), 3u);
  bool some_unreachable = false;
  for (const BucketVerdict& bucket : verdict.buckets) {
    EXPECT_EQ(bucket.oracle, "brute-force");
    EXPECT_EQ(bucket.sampled, 200u);
    EXPECT_EQ(bucket.wrong_value + bucket.earlier_hit + bucket.false_nan, 0u);
    EXPECT_GT(bucket.reachable, 50u);
    some_unreachable |= bucket.reachable < bucket.sampled;
    EXPECT_LE(bucket.largest_residual, k_distance_tolerance * k_a.diagonal());
  }
  EXPECT_TRUE(some_unreachable);
}

TEST(Verification, FindsDistancesThatAreOff) {
  // By twice the tolerance where faces are parallel.
  const Verdict verdict = verify_after([](auto& buckets) {
    for_all(buckets[1], [](double s) { return s + 2.0 * k_distance_tolerance * k_a.diagonal(); });
  });
  EXPECT_GT(verdict.buckets[1].wrong_value, 0u);
  EXPECT_EQ(verdict.buckets[0].wrong_value + verdict.buckets[0].earlier_hit + verdict.buckets[0].false_nan, 0u);
  EXPECT_EQ(verdict.buckets[2].wrong_value + verdict.buckets[2].earlier_hit + verdict.buckets[2].false_nan, 0u);
  EXPECT_THAT(verdict.problems, Contains(HasSubstr("distance/02")));
}

TEST(Verification, FindsAHitThatIsNotTheFirst) {
  // At the inner side of the near wall: the distance is right, but it is not the first hit.
  const double wall = 1.0, half_wall = 0.05;
  const Verdict verdict = verify_after(
      [&](auto& buckets) {
        const std::size_t n = k_grid.directions.size();
        const double target = buckets[1].summary.target;
        for (std::size_t i = 0; i < buckets[1].translations.size(); ++i) {
          if (k_grid.directions[i % n].x() != 1.0) continue;
          double& s = buckets[1].translations[i];
          const double half_b = s - target - wall - half_wall;
          s = wall - half_wall - half_b - target;
        }
      },
      400);
  EXPECT_GT(verdict.buckets[1].earlier_hit, 0u);
  EXPECT_EQ(verdict.buckets[1].wrong_value, 0u);
}

TEST(Verification, FindsFalseNaN) {
  const Verdict verdict = verify_after(
      [](auto& buckets) { for_all(buckets[2], [](double) { return std::numeric_limits<double>::quiet_NaN(); }); });
  EXPECT_GT(verdict.buckets[2].false_nan, 0u);
  EXPECT_THAT(verdict.problems, Contains(HasSubstr("unreachable")));
  // A farther bucket is reachable wherever a nearer one is.
  EXPECT_THAT(verdict.problems, Contains(HasSubstr("is met at")));
}

TEST(Verification, FindsSummariesAndCopiesThatDoNotFit) {
  EXPECT_THAT(verify_after([](auto& buckets) { buckets[0].summary.target *= 10.0; }, 0).problems,
              Contains(HasSubstr("distance/00: nominal")));
  EXPECT_THAT(verify_after([](auto& buckets) { buckets[0].summary.tolerance *= 2.0; }, 0).problems,
              Contains(HasSubstr("distance/00: tolerance")));
  EXPECT_THAT(verify_after([](auto& buckets) { buckets[0].summary.largest_residual = 1.0; }, 0).problems,
              Contains(HasSubstr("largest residual")));
  const auto map = DistinctRotations(k_grid.rotations).representative;
  std::size_t copy = 0;
  while (map[copy] == copy) ++copy;
  const std::size_t n = k_grid.directions.size();
  EXPECT_THAT(verify_after([&](auto& buckets) { buckets[2].translations[copy * n] = 2.125; }, 0).problems,
              Contains(HasSubstr("are equal, their translations are not")));
}

TEST(Verification, StopsWhenAsked) {
  const auto path =
      std::filesystem::path(testing::TempDir()) / ("sixdof_verify_stop" + std::to_string(::getpid()) + ".h5");
  ConfigurationSetWriter writer(
      path, {.generator_version = "0", .a = MeshIdentity::of(k_a), .b = MeshIdentity::of(k_b), .grid = k_grid});
  writer.write(distance_bucket(k_a, 5), std::vector<double>(k_grid.configurations(), 1.0));
  writer.commit();
  const ConfigurationSet set(path);
  EXPECT_THROW(verify_set(set, k_a, k_b, *k_brute_force, {}, {.cancelled = [] { return true; }}), Interrupted);
  EXPECT_THROW(verify_set(set, k_b, k_b, *k_brute_force), BadArgument);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace sixdof
