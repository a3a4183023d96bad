#include <sixdof/configuration/bucket.h>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/models/recipe.h>

namespace sixdof {
namespace {

TEST(Bucket, AKeyIsReadBackFromItsName) {
  using enum BucketKind;
  for (const auto& [key, name] : {std::pair(BucketKey{distance, 5}, "distance/05"),
                                  {BucketKey{volume, 10}, "volume/10"},
                                  {BucketKey{distance, 0.5}, "distance/0.5"},
                                  {BucketKey{distance, 100}, "distance/100"},
                                  {BucketKey{volume, 0.125}, "volume/0.125"}}) {
    EXPECT_EQ(key.name(), name);
    EXPECT_EQ(BucketKey::parse(name), key);
    EXPECT_EQ(key.name(), to_string(key.kind) + '/' + key.percent_text());
  }
  for (const char* wrong : {"", "distance", "distance/", "depth/05", "volume/101", "volume/-1", "distance/1e1"}) {
    EXPECT_THROW(BucketKey::parse(wrong), BadArgument) << wrong;
  }
}

TEST(Bucket, APercentageIsADecimalNumberUpToAHundred) {
  EXPECT_EQ(parse_percent("5"), 5.0);
  EXPECT_EQ(parse_percent("05"), 5.0);
  EXPECT_EQ(parse_percent("0.125"), 0.125);
  EXPECT_EQ(parse_percent("100"), 100.0);
  for (const char* wrong : {"", ".", "-1", "+1", "1e1", "nan", "100.001", "0.1234", " 1", "1 ", "0x1"}) {
    EXPECT_FALSE(parse_percent(wrong)) << '"' << wrong << '"';
  }
}

TEST(Bucket, NominalIsOfTheDiagonalOrTheVolumeOfA) {
  const Mesh box = make_box({.size = {1.0, 2.0, 2.0}}, 12);
  constexpr double k_rounding = 1e-15;  // of a product
  const BucketSummary far = distance_bucket(box, 50), deep = volume_bucket(box, 25);
  EXPECT_NEAR(far.nominal, 1.5, k_rounding);
  EXPECT_EQ(far.target, far.nominal);
  EXPECT_NEAR(far.tolerance, 3.0 * k_distance_tolerance, k_rounding * k_distance_tolerance * 3.0);
  EXPECT_NEAR(deep.nominal, 1.0, k_rounding);
  EXPECT_NEAR(deep.tolerance, 4.0 * k_volume_tolerance, k_rounding * k_volume_tolerance * 4.0);
  const BucketSummary contact = distance_bucket(box, 0);
  EXPECT_EQ(contact.nominal, 0.0);
  EXPECT_GT(contact.target, 0.0) << "just outside contact";
  EXPECT_LT(contact.target, contact.tolerance);
  EXPECT_THROW(distance_bucket(box, 101), BadArgument);
  EXPECT_THROW(volume_bucket(box, 0.1234), BadArgument);
}

}  // namespace
}  // namespace sixdof
