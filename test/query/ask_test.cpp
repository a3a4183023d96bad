#include <sixdof/query/ask.h>

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

struct Silent final : Query {};

/// What becomes of an answer, and the words.
std::pair<Status, std::string> examined(const Impact& impact) {
  Silent query;
  Outcome<Impact> answer = impact;
  std::string words;
  examine(query, answer, [&](const std::string& why) { words = why; });
  return {answer.status, words};
}

TEST(Ask, AcceptsTimesFromZeroToOne) {
  for (const double t : {0.0, 0.3, 1.0}) EXPECT_EQ(examined({.hit = true, .t = t}).first, Status::ok) << t;
  EXPECT_EQ(examined({.hit = false, .t = 7.0}).first, Status::ok) << "without a hit there is no time";
  EXPECT_TRUE((Impact{.hit = true}.at_start()));
  EXPECT_FALSE((Impact{.hit = true, .t = 1e-300}.at_start()));
  EXPECT_FALSE(Impact{}.at_start());
}

TEST(Ask, RefusesOtherTimes) {
  for (const double t : {-1e-300, 1.0 + 1e-15, 2.0}) {
    const auto [status, words] = examined({.hit = true, .t = t});
    EXPECT_EQ(status, Status::failed) << t;
    EXPECT_EQ(words, "the time of impact is not from 0 to 1");
  }
  for (const double t : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(examined({.hit = true, .t = t}).first, Status::non_finite);
  }
}

TEST(Ask, AQueryWithoutACastSaysSo) {
  Silent query;
  EXPECT_EQ(query.cast(Motion{}).status, Status::unsupported);
}

}  // namespace
}  // namespace sixdof
