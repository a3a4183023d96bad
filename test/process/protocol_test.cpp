#include <sixdof/process/protocol.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sixdof::protocol {
namespace {

using ::testing::HasSubstr;

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// Numbers whose shortest decimal has few digits, many, or none.
const std::vector<double> k_hard_numbers{
    0.1,         1.0 / 3.0,  -0.0, 5e-324, 2.2250738585072011e-308, 1.7976931348623157e308, 9007199254740993.0,
    -k_infinity, k_infinity, 3.0};

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

Pose hard_pose(std::size_t shift) {
  Pose X_AB;
  const auto next = [&] { return k_hard_numbers[shift++ % k_hard_numbers.size()]; };
  for (int i = 0; i < 9; ++i) X_AB.R(i / 3, i % 3) = next();
  for (int i = 0; i < 3; ++i) X_AB.t[i] = next();
  return X_AB;
}

bool same_bits(const Pose& a, const Pose& b) {
  for (int i = 0; i < 9; ++i) {
    if (!same_bits(a.R(i / 3, i % 3), b.R(i / 3, i % 3))) return false;
  }
  for (int i = 0; i < 3; ++i) {
    if (!same_bits(a.t[i], b.t[i])) return false;
  }
  return true;
}

TEST(Protocol, PosesKeepAllBits) {
  for (std::size_t shift = 0; shift < k_hard_numbers.size(); ++shift) {
    const Pose X_AB = hard_pose(shift);
    const Request ask = request_of(to_line(Ask{"distance", X_AB}));
    EXPECT_EQ(std::get<Ask>(ask).query, "distance");
    EXPECT_TRUE(same_bits(std::get<Ask>(ask).X_AB, X_AB)) << shift;
  }
  const Request time = request_of(to_line(Time{"respond", {hard_pose(1), hard_pose(2)}, 3, true, 77}));
  EXPECT_TRUE(same_bits(std::get<Time>(time).poses.at(1), hard_pose(2)));
  EXPECT_EQ(std::get<Time>(time).passes, 3u);
  EXPECT_TRUE(std::get<Time>(time).each);
  EXPECT_EQ(std::get<Time>(time).evict_bytes, 77u);
}

TEST(Protocol, AnswersKeepAllBits) {
  for (const double x : k_hard_numbers) {
    const double y = k_hard_numbers[3], z = k_hard_numbers[1];
    const Separation gap{x, true, {y, x, z}, {x, z, y}, 7, 4294967294u};
    const auto distance = asked_of<Separation>(to_line(Asked<Separation>{gap, "", 12.5, {{"points", x, 3.0}}}));
    ASSERT_TRUE(distance.outcome.ok());
    EXPECT_TRUE(same_bits(distance.outcome.value.distance, x));
    EXPECT_TRUE(same_bits(distance.outcome.value.witness_a.y(), x));
    EXPECT_TRUE(same_bits(distance.outcome.value.witness_b.z(), y));
    EXPECT_EQ(distance.outcome.value.triangle_a, 7u);
    EXPECT_EQ(distance.outcome.value.triangle_b, 4294967294u);
    EXPECT_EQ(distance.ns, 12.5);
    EXPECT_EQ(distance.work.at(0).unit, "points");
    EXPECT_TRUE(same_bits(distance.work.at(0).tested, x));

    const Response push{x, z, {x, y, z}, {z, x, y}, {y, z, x}};
    const auto response = asked_of<Response>(to_line(Asked<Response>{push, "", {}, {}}));
    EXPECT_TRUE(same_bits(response.outcome.value.penalty, x));
    EXPECT_TRUE(same_bits(response.outcome.value.volume, z));
    EXPECT_TRUE(same_bits(response.outcome.value.force.x(), x));
    EXPECT_TRUE(same_bits(response.outcome.value.torque.y(), x));
    EXPECT_TRUE(same_bits(response.outcome.value.reference.z(), x));
    EXPECT_FALSE(response.ns);
  }
}

TEST(Protocol, CastsKeepAllBits) {
  for (const double x : k_hard_numbers) {
    const double y = k_hard_numbers[0], z = k_hard_numbers[1];
    const Motion motion{hard_pose(2), {x, y, z}, {y, z, x}, {z, x, y}};
    const Request request = request_of(to_line(Ask{"cast", motion.start, motion}));
    const Motion& read = *std::get<Ask>(request).motion;
    EXPECT_TRUE(same_bits(read.start, motion.start));
    EXPECT_TRUE(same_bits(read.translation.x(), x) && same_bits(read.rotation.z(), x) &&
                same_bits(read.reference.y(), x));

    const Impact impact{true, 0.1, true, {x, y, z}, {y, x, z}, {z, y, x}};
    const Impact answer = asked_of<Impact>(to_line(Asked<Impact>{impact, "", 3.5, {}})).outcome.value;
    EXPECT_TRUE(answer.hit && same_bits(answer.t, 0.1) && answer.has_witnesses);
    EXPECT_TRUE(same_bits(answer.witness_a.x(), x) && same_bits(answer.witness_b.y(), x) &&
                same_bits(answer.normal.z(), x));
  }
  EXPECT_FALSE(asked_of<Impact>(R"({"hit": false})").outcome.value.hit);
  EXPECT_FALSE(asked_of<Impact>(R"({"hit": true, "t": 0})").outcome.value.has_witnesses);
  EXPECT_EQ(answer_of<Impact>(R"({"hit": true, "t": 1.5})").outcome.status, Status::failed) << "behind the end";
  EXPECT_EQ(answer_of<Impact>(R"({"hit": true, "t": "nan"})").outcome.status, Status::non_finite);
  EXPECT_THROW(request_of(R"({"do": "ask", "query": "cast", "pose": [1,0,0,0,1,0,0,0,1,0,0,0]})"), Malformed)
      << "without a motion";
}

TEST(Protocol, ContactsKeepAllBits) {
  for (const double x : k_hard_numbers) {
    const double y = k_hard_numbers[0], z = k_hard_numbers[1];
    const Request request = request_of(to_line(Ask{"contacts", hard_pose(2), {}, 77}));
    EXPECT_EQ(std::get<Ask>(request).most, 77u);
    EXPECT_TRUE(same_bits(std::get<Ask>(request).X_AB, hard_pose(2)));

    const Contacts contacts{{{{x, y, z}, {y, x, z}, x}, {{z, y, x}, {z, x, y}, z}}};
    const auto asked = asked_of<Contacts>(to_line(Asked<Contacts>{contacts, "", 3.5, {}}));
    const std::vector<Contact>& read = asked.outcome.value.list;
    ASSERT_EQ(read.size(), 2u);
    EXPECT_TRUE(same_bits(read[0].point.x(), x) && same_bits(read[0].normal.y(), x) && same_bits(read[0].depth, x));
    EXPECT_TRUE(same_bits(read[1].point.z(), x) && same_bits(read[1].normal.y(), x) && same_bits(read[1].depth, z));
  }
  EXPECT_TRUE(asked_of<Contacts>(R"({"points": [], "normals": [], "depths": []})").outcome.value.list.empty());
  EXPECT_EQ(answer_of<Contacts>(R"({"points": [[0,0,0]], "normals": [[0,0,2]], "depths": [1]})").outcome.status,
            Status::failed)
      << "no unit vector";
  EXPECT_EQ(answer_of<Contacts>(R"({"points": [[0,0,0]], "normals": [[0,0,1]], "depths": ["nan"]})").outcome.status,
            Status::non_finite);
  for (const char* line : {R"({"points": [[0,0,0]], "normals": [], "depths": [1]})", R"({"points": 3})",
                           R"({"points": [[0,0]], "normals": [[0,0,1]], "depths": [1]})"}) {
    EXPECT_THROW(asked_of<Contacts>(line), Malformed) << line;
  }
  EXPECT_THROW(request_of(R"({"do": "ask", "query": "contacts", "pose": [1,0,0,0,1,0,0,0,1,0,0,0]})"), Malformed)
      << "without a number";
}

TEST(Protocol, TheMeaningOfDepthsIsSaid) {
  Greeting greeting;
  greeting.traits = {.name = "mine", .version = "1", .answers = {.contacts = true}, .depth = ContactDepth::point};
  const Traits read = greeting_of(to_line(greeting)).traits;
  EXPECT_TRUE(read.answers.contacts);
  EXPECT_EQ(read.depth, ContactDepth::point);
}

TEST(Protocol, WhatIsAbsentStaysAbsent) {
  const auto gap = asked_of<Separation>(R"({"distance": 2})").outcome.value;
  EXPECT_FALSE(gap.has_witnesses);
  EXPECT_EQ(gap.triangle_a, Separation::k_no_triangle);
  const Response push{.penalty = k_nan};
  const auto response = asked_of<Response>(to_line(Asked<Response>{push, "", {}, {}})).outcome.value;
  EXPECT_TRUE(std::isnan(response.penalty));
  EXPECT_TRUE(std::isnan(response.volume));
  EXPECT_TRUE(asked_of<bool>(R"({"collide": true, "colour": "red"})").outcome.value) << "unknown keys are ignored";
}

TEST(Protocol, StatusesHaveWords) {
  const auto failed = asked_of<bool>(to_line(Asked<bool>{Status::out_of_memory, "too many nodes", {}, {}}));
  EXPECT_EQ(failed.outcome.status, Status::out_of_memory);
  EXPECT_EQ(failed.words, "too many nodes");
  EXPECT_EQ(asked_of<bool>(to_line(Asked<bool>{Status::failed, "bad byte \xFF", {}, {}})).outcome.status,
            Status::failed);
  EXPECT_THROW(asked_of<bool>(R"({"status": "crashed"})"), Malformed) << "a process that has crashed cannot say so";
}

TEST(Protocol, GreetingsAndPreparations) {
  const Greeting sent{{.name = "x",
                       .version = "1.5",
                       .summary = "s",
                       .answers = {.collide = true, .respond = true},
                       .law = ResponseLaw::volume,
                       .limits = {.surfaces_only = {.respond = true}, .own_direction = true},
                       .parameters = {Parameter::count("n", "how many", "5", 1, 9).swept({"1", "5"}),
                                      Parameter::choice("mode", "which", "b", {"a", "b"})}},
                      true,
                      false};
  const Greeting read = greeting_of(to_line(sent));
  EXPECT_EQ(read.traits.version, "1.5");
  EXPECT_TRUE(read.traits.answers.collide && read.traits.answers.respond && !read.traits.answers.distance);
  EXPECT_EQ(read.traits.law, ResponseLaw::volume);
  const MethodLimits& limits = read.traits.limits;
  EXPECT_TRUE(limits.surfaces_only.respond && limits.own_direction);
  EXPECT_FALSE(limits.surfaces_only.collide || limits.distance_of_bodies || limits.points_of_b_only);
  EXPECT_EQ(read.traits.parameters.at(0).high, 9.0);
  EXPECT_TRUE(read.traits.parameters.at(0).integer);
  EXPECT_EQ(read.traits.parameters.at(0).sweep, (std::vector<std::string>{"1", "5"}));
  EXPECT_EQ(read.traits.parameters.at(1).choices, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(read.times);
  EXPECT_FALSE(read.progress);

  const auto prepared = prepared_of(to_line(Prepared{5.0, 4.0, {.bytes = 9, .counts = {{"z", 1}, {"a", 2.5}}}}));
  const auto& made = std::get<Prepared>(prepared);
  EXPECT_EQ(made.wall_ns, 5.0);
  EXPECT_EQ(made.footprint.bytes, 9u);
  EXPECT_EQ(made.footprint.counts.at(0).first, "z") << "in their order";
  EXPECT_EQ(made.footprint.counts.at(1).second, 2.5);
  const auto refused = prepared_of(to_line(Refusal{Refusal::Kind::bad_mesh, "open"}));
  EXPECT_EQ(std::get<Refusal>(refused).kind, Refusal::Kind::bad_mesh);
  EXPECT_EQ(std::get<Refusal>(refused).words, "open");
}

TEST(Protocol, TimesBelongToPoses) {
  const auto timed = timed_of(to_line(Timed{{1, 2}, {1, 1.5}, 0, 0, {{1, Status::non_finite, "nan"}}}), 2, true);
  EXPECT_EQ(timed.least_ns, (std::vector<double>{1, 1.5}));
  EXPECT_EQ(timed.failed.at(0).place, 1u);
  EXPECT_EQ(timed.failed.at(0).status, Status::non_finite);
  EXPECT_EQ(timed_of(R"({"wall_ns": 8, "cpu_ns": 7})", 2, false).cpu_ns, 7.0);
  EXPECT_THROW(timed_of(to_line(Timed{{1}, {1}, 0, 0, {}}), 2, true), Malformed);
  EXPECT_THROW(timed_of(to_line(Timed{{1, 2}, {1, 2}, 0, 0, {{2, Status::failed, ""}}}), 2, true), Malformed);
  for (const char* const line :
       {R"({"cpu_ns": 7})", R"({"wall_ns": -8, "cpu_ns": 7})", R"({"wall_ns": 8, "cpu_ns": "inf"})",
        R"({"wall_ns": 8, "cpu_ns": 7, "failed": [[-1, "failed", ""]]})",
        R"({"wall_ns": 8, "cpu_ns": 7, "failed": [[0.5, "failed", ""]]})",
        R"({"wall_ns": 8, "cpu_ns": 7, "failed": [[1e300, "failed", ""]]})",
        R"({"wall_ns": 8, "cpu_ns": 7, "failed": [[1, "failed", ""], [1, "failed", ""]]})"}) {
    EXPECT_THROW(timed_of(line, 2, false), Malformed) << line;
  }
  EXPECT_THROW(timed_of(R"({"once_ns": {"a": 1, "b": 2}, "least_ns": [1, 2]})", 2, true), Malformed);
}

TEST(Protocol, CountsAreWholeNumbers) {
  const auto passes_of = [](const std::string& passes) {
    const std::string line =
        R"({"do": "time", "query": "distance", "each": true, "evict_bytes": 0, "poses": [], "passes": )" + passes + "}";
    return std::get<Time>(request_of(line)).passes;
  };
  EXPECT_EQ(passes_of("3"), 3u);
  EXPECT_EQ(passes_of("3.0"), 3u) << "of a language without integers";
  EXPECT_EQ(passes_of("18446744073709551615"), std::numeric_limits<std::size_t>::max());
  for (const char* const wrong : {"-1", "2.5", "1e300", "true", "null", "\"3\"", "[3]", "18446744073709551616"}) {
    EXPECT_THROW(passes_of(wrong), Malformed) << wrong;
  }
}

TEST(Protocol, AnAnswerThatIsNotFiniteIsNone) {
  for (const char* const word : {"nan", "inf", "-inf"}) {
    const std::string number = '"' + std::string(word) + '"';
    const auto distance = answer_of<Separation>("{\"distance\": " + number + "}");
    EXPECT_EQ(distance.outcome.status, Status::non_finite) << word;
    EXPECT_EQ(distance.words, "the answer is not finite");
    const auto response = answer_of<Response>(R"({"penalty": 1, "force": [0, )" + number +
                                              R"(, 0], "torque": [0, 0, 0], "reference": [0, 0, 0]})");
    EXPECT_EQ(response.outcome.status, Status::non_finite) << word;
  }
  EXPECT_TRUE(answer_of<Separation>(R"({"distance": 2})").outcome.ok());
  EXPECT_TRUE(answer_of<bool>(R"({"collide": true})").outcome.ok());
}

TEST(Protocol, RefusesNonsenseWithTheLine) {
  const auto words_of = [](const std::string& line) -> std::string {
    try {
      asked_of<Separation>(line);
    } catch (const Malformed& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_THAT(words_of("Hello, I am a library"), HasSubstr(R"("Hello, I am a library": )"));
  EXPECT_THAT(words_of("{}"), HasSubstr("key 'distance' not found"));
  for (const char* const line : {"",
                                 "7",
                                 "[]",
                                 "null",
                                 R"({"distance": "near"})",
                                 R"({"distance": null})",
                                 R"({"distance": NaN})",
                                 R"({"collide": true})",
                                 R"({"distance": 1)",
                                 R"({"distance": 1, "a": [1, 2], "b": [1, 2, 3]})",
                                 R"({"distance": 1, "a": [1, 2, 3]})",
                                 R"({"distance": 1, "triangle_a": "x"})",
                                 R"({"distance": 1, "ns": []})",
                                 R"({"distance": 1, "triangle_a": 1.5})",
                                 R"({"distance": 1, "triangle_b": -1})",
                                 R"({"distance": 1, "triangle_b": 4294967296})",
                                 R"({"distance": 1, "triangle_a": true})",
                                 R"({"distance": 1, "triangle_a": 1e300})",
                                 R"({"distance": 1, "ns": -1})",
                                 R"({"distance": 1, "ns": "nan"})",
                                 R"({"status": "fine"})",
                                 R"({"distance": 1, "work": [["points"]]})",
                                 "\xFF\xFE"}) {
    EXPECT_NE(words_of(line), "accepted") << line;
  }
  EXPECT_LT(words_of(std::string(100'000, 'x')).size(), 300u) << "long lines are cut";
  for (const char* const line : {R"({"do": "dance"})", R"({"do": "hello", "protocol": 2})", R"({"do": "hello"})",
                                 R"({"do": "ask", "query": "distance", "pose": [1, 2]})"}) {
    EXPECT_THROW(request_of(line), Malformed) << line;
  }
  EXPECT_THROW(greeting_of(R"({"protocol": 2, "name": "x", "version": "1", "answers": []})"), Malformed);
  EXPECT_THROW(greeting_of(R"({"protocol": 1, "name": "x", "version": "1", "answers": ["dance"]})"), Malformed);
  EXPECT_THROW(greeting_of(R"({"protocol": 1, "name": "x", "version": "1", "answers": [], "limits": ["no"]})"),
               Malformed);
  EXPECT_THROW(prepared_of(R"({"prepared": false})"), Malformed);
}

}  // namespace
}  // namespace sixdof::protocol
