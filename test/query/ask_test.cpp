#include <sixdof/query/ask.h>

#include <limits>
#include <string>
#include <utility>
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

/// Answers with what it is given.
struct Giving final : Query {
  explicit Giving(Contacts given) : given_(std::move(given)) {}
  Outcome<Contacts> contacts(const Pose&, std::size_t) override { return given_; }
  Contacts given_;
};

/// What becomes of contacts of which `most` are asked for, and the words.
std::pair<Status, std::string> examined(Contacts contacts, std::size_t most = 2) {
  Giving query(std::move(contacts));
  std::string words;
  const Outcome<Contacts> answer = ask_contacts(query, {}, most, [&](const std::string& why) { words = why; });
  return {answer.status, words};
}

const Contact k_contact{{0.3, -2.0, 1.0}, {0.6, 0.0, -0.8}, 0.01};

TEST(Ask, AcceptsAsManyContactsAsAreAskedFor) {
  for (std::size_t count = 0; count < 3; ++count) {
    EXPECT_EQ(examined({std::vector(count, k_contact)}), std::pair(Status::ok, std::string())) << count;
  }
  const auto [status, words] = examined({std::vector(3, k_contact)});
  EXPECT_EQ(status, Status::failed);
  EXPECT_EQ(words, "more contacts than the 2 that were asked for");
}

TEST(Ask, RefusesContactsThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Contact> bad(3, k_contact);
  bad[0].point.y() = nan;
  bad[1].normal.z() = std::numeric_limits<double>::infinity();
  bad[2].depth = nan;
  for (const Contact& each : bad) EXPECT_EQ(examined({{k_contact, each}}).first, Status::non_finite);
}

TEST(Ask, RefusesNormalsThatAreNoUnitVectors) {
  for (const double factor : {0.0, 0.99, 1.01}) {
    Contact bad = k_contact;
    bad.normal *= factor;
    const auto [status, words] = examined({{k_contact, bad}});
    EXPECT_EQ(status, Status::failed) << factor;
    EXPECT_EQ(words, "a contact's normal is no unit vector");
  }
}

TEST(Ask, AQueryWithoutContactsSaysSo) {
  Silent query;
  std::string words;
  EXPECT_EQ(ask_contacts(query, {}, 1, [&](const std::string& why) { words = why; }).status, Status::unsupported);
  EXPECT_EQ(words, "the algorithm gives no such answer");
}

TEST(Ask, AQueryWithoutACastSaysSo) {
  Silent query;
  EXPECT_EQ(query.cast(Motion{}).status, Status::unsupported);
}

}  // namespace
}  // namespace sixdof
