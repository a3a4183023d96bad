#include <sixdof/generation/repetition.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/configuration_set.h>
#include <sixdof/generation/volume_generator.h>
#include <sixdof/models/model_catalogue.h>

namespace sixdof {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::size_t k_all = 0;

/// A set of two small models, made once, edited and written.
class RepetitionTest : public testing::Test {
 protected:
  using Edit = std::function<void(std::vector<Bucket>&)>;

  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("repetition_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  ConfigurationSet write(const Edit& edit = [](std::vector<Bucket>&) {}) const {
    static const std::vector<Bucket> made = [] {
      std::vector<Bucket> buckets = generate_distances(*generator(), a(), b(), grid(), k_distances).buckets;
      for (Bucket& bucket : generate_volumes(*generator(), a(), b(), grid(), k_volumes).buckets) {
        buckets.push_back(std::move(bucket));
      }
      return buckets;
    }();
    std::vector<Bucket> buckets = made;
    edit(buckets);
    const auto path = folder_ / "set.h5";
    ConfigurationSetWriter writer(
        path, {.generator_version = "0", .a = MeshIdentity::of(a()), .b = MeshIdentity::of(b()), .grid = grid()});
    for (const Bucket& bucket : buckets) writer.write(bucket.summary, bucket.translations);
    writer.commit();
    return ConfigurationSet(path);
  }

  static Repetition again(const ConfigurationSet& set, const RepetitionSample& sample = {.rotations = k_all}) {
    return make_again(set, a(), b(), *generator(), sample);
  }

  static const Mesh& a() {
    static const Mesh mesh = load_model("torus-knot-1k");
    return mesh;
  }
  static const Mesh& b() {
    static const Mesh mesh = load_model("cone-1k");
    return mesh;
  }
  static const Grid& grid() {
    static const Grid grid = make_grid("90");
    return grid;
  }
  static const DistanceGenerator* generator() {
    static const std::unique_ptr<DistanceGenerator> ray_cast = make_ray_cast();
    return ray_cast.get();
  }

  inline static const std::vector<double> k_distances{0, 10};
  inline static const std::vector<double> k_volumes{0, 2};
  std::filesystem::path folder_;
};

TEST_F(RepetitionTest, FindsTheSameBits) {
  const ConfigurationSet set = write();
  const Repetition repetition = again(set);
  EXPECT_TRUE(repetition.same());
  const std::size_t distinct = DistinctRotations(grid().rotations).first.size();
  EXPECT_EQ(repetition.values(), 4 * distinct * grid().directions.size());
}

TEST_F(RepetitionTest, OfASampleFindsTheSameBits) {
  const ConfigurationSet set = write();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Repetition repetition = again(set, {.rotations = 3, .seed = seed});
    EXPECT_TRUE(repetition.same());
    EXPECT_EQ(repetition.values(), 4 * 3 * grid().directions.size());
  }
}

// One bit of one value of each kind of bucket, in the last place.
TEST_F(RepetitionTest, FindsOneChangedBit) {
  const std::size_t directions = grid().directions.size();
  const std::uint32_t rotation = DistinctRotations(grid().rotations).first[5];
  for (const std::size_t bucket : {std::size_t{1}, std::size_t{3}}) {
    double before = 0.0;
    std::uint32_t direction = 0;
    const ConfigurationSet set = write([&](std::vector<Bucket>& buckets) {
      std::vector<double>& values = buckets[bucket].translations;
      while (std::isnan(values[rotation * directions + direction])) ++direction;
      double& value = values[rotation * directions + direction];
      before = value;
      value = std::nextafter(value, 0.0);
    });
    const Repetition repetition = again(set);
    EXPECT_FALSE(repetition.same());
    EXPECT_EQ(repetition.changed(), 1U);
    const BucketRepetition& found = repetition.buckets[bucket];
    EXPECT_EQ(found.changed, 1U);
    EXPECT_EQ(found.largest.rotation, rotation);
    EXPECT_EQ(found.largest.direction, direction);
    EXPECT_EQ(found.largest.made, before);
    EXPECT_EQ(found.largest.stored, std::nextafter(before, 0.0));
  }
}

TEST_F(RepetitionTest, FindsAnUnreachedConfigurationThatIsReached) {
  const std::uint32_t rotation = DistinctRotations(grid().rotations).first[2];
  const ConfigurationSet set = write([&](std::vector<Bucket>& buckets) {
    std::vector<double>& values = buckets[0].translations;
    values[rotation * grid().directions.size()] = std::numeric_limits<double>::quiet_NaN();
    values[rotation * grid().directions.size() + 1] =
        std::nextafter(values[rotation * grid().directions.size() + 1], 0);
  });
  const Repetition repetition = again(set);
  EXPECT_EQ(repetition.changed(), 2U);
  EXPECT_TRUE(std::isnan(repetition.buckets[0].largest.stored));
}

TEST_F(RepetitionTest, FindsAnotherTolerance) {
  const ConfigurationSet set = write([](std::vector<Bucket>& buckets) { buckets[1].summary.tolerance *= 2; });
  const Repetition repetition = again(set, {.rotations = 1});
  EXPECT_FALSE(repetition.same());
  EXPECT_EQ(repetition.changed(), 0U);
  EXPECT_THAT(repetition.differences, Contains(HasSubstr("distance/10: tolerance")));
}

TEST_F(RepetitionTest, FindsAnOlderMethod) {
  const ConfigurationSet set = write([](std::vector<Bucket>& buckets) { buckets[3].summary.oracle_version = "0.0.1"; });
  EXPECT_THAT(again(set, {.rotations = 1}).differences,
              testing::ElementsAre(HasSubstr("volume/02: oracle version 0.0.1")));
}

TEST_F(RepetitionTest, RefusesOtherMeshesAndMethods) {
  const ConfigurationSet set = write();
  EXPECT_THROW(make_again(set, b(), a(), *generator()), BadArgument);
  const ConfigurationSet other = write([](std::vector<Bucket>& buckets) { buckets[0].summary.oracle = "fcl-rss"; });
  EXPECT_EQ(distance_oracle(other), "fcl-rss");
  EXPECT_THROW(again(other), BadArgument);
}

}  // namespace
}  // namespace sixdof
