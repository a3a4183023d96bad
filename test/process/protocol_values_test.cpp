#include <sixdof/process/protocol_values.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

namespace sixdof::protocol {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// As it comes over the wire.
Json sent(const Json& json) { return Json::parse(json.dump()); }

TEST(ProtocolValues, NumbersKeepTheirBitsAndHaveWordsForWhatIsNotFinite) {
  for (const double x : {0.0, -0.0, 0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, k_infinity, -k_infinity}) {
    const double back = number_of(sent(number(x)));
    EXPECT_EQ(back, x);
    EXPECT_EQ(std::signbit(back), std::signbit(x));
  }
  EXPECT_TRUE(std::isnan(number_of(sent(number(std::nan(""))))));
  EXPECT_THROW(number_of(Json("one")), Malformed);
}

TEST(ProtocolValues, CountsAreWholeAndInRange) {
  EXPECT_EQ(count_of<std::uint32_t>(Json::parse("7")), 7u);
  EXPECT_EQ(count_of<std::uint32_t>(Json::parse("7.0")), 7u);
  EXPECT_EQ(count_of<std::uint64_t>(Json::parse("18446744073709551615")), std::numeric_limits<std::uint64_t>::max());
  for (const char* bad : {"-1", "7.5", "4294967296", "1e300", "\"7\"", "null"}) {
    EXPECT_THROW(count_of<std::uint32_t>(Json::parse(bad)), Malformed) << bad;
  }
}

TEST(ProtocolValues, TimesAreFiniteAndNotNegative) {
  EXPECT_EQ(times_of(Json::parse("[0, 1.5, 2e9]")), (std::vector<double>{0.0, 1.5, 2e9}));
  for (const char* bad : {"[-1]", "[\"nan\"]", "[\"inf\"]", "{}"}) {
    EXPECT_THROW(times_of(Json::parse(bad)), Malformed) << bad;
  }
}

TEST(ProtocolValues, PosesAndMotionsComeBackAsTheyWere) {
  const Pose X{Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix(), {0.1, -4e9, 7e-300}};
  const Pose back = pose_of(sent(pose(X)));
  EXPECT_EQ(back.R, X.R);
  EXPECT_EQ(back.t, X.t);
  const Json json{
      {"translation", vector({1, 2, 3})}, {"rotation", vector({0.1, 0, 0})}, {"reference", vector({4, 5, 6})}};
  const Motion motion = motion_of(sent(json), X);
  EXPECT_EQ(motion.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(motion.rotation, Eigen::Vector3d(0.1, 0, 0));
  EXPECT_EQ(motion.reference, Eigen::Vector3d(4, 5, 6));
  EXPECT_THROW(pose_of(Json::parse("[1,0,0]")), Malformed);
  EXPECT_THROW(vector_of(Json::parse("[1,0]")), Malformed);
}

TEST(ProtocolValues, ContactsComeBackAndNeedListsOfOneLength) {
  Json json;
  put(json, Contacts{{{{0.1, 0.2, 0.3}, {0.0, 0.0, 1.0}, 0.01}, {{1.0, 2.0, 3.0}, {0.0, 1.0, 0.0}, -0.5}}});
  Contacts back;
  take(sent(json), back);
  ASSERT_EQ(back.list.size(), 2u);
  EXPECT_EQ(back.list[1].point, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(back.list[0].normal, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(back.list[1].depth, -0.5);
  json["depths"].push_back(1.0);
  Contacts other;
  EXPECT_THROW(take(json, other), Malformed);
}

}  // namespace
}  // namespace sixdof::protocol
