#include <sixdof/stability/judge.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/stability/bodies.h>
#include <sixdof/stability/shots.h>

#include "exact_algorithm.h"

namespace sixdof::stability {
namespace {

/// Says what it is told to say.
struct Script {
  Outcome<bool> collide = Status::unsupported;
  Outcome<Separation> distance = Status::unsupported;
  Outcome<Response> respond = Status::unsupported;
  double resolution = 0.0;
  bool throws = false, refuses = false;
  std::chrono::milliseconds delay{0};
};

class Scripted : public Query {
 public:
  explicit Scripted(const Script& script) : script_(script) {}
  Outcome<bool> collide(const Pose&) override {
    std::this_thread::sleep_for(script_.delay);
    if (script_.throws) throw std::runtime_error("assertion of a library");
    return script_.collide;
  }
  Outcome<Separation> distance(const Pose&) override { return script_.distance; }
  Outcome<Response> respond(const Pose&) override { return script_.respond; }
  Footprint footprint() const override {
    if (script_.resolution == 0.0) return {};
    return {.bytes = 0, .counts = {{"resolution", script_.resolution}}};
  }

 private:
  Script script_;
};

const Shot& apart_by_a_tenth() {
  static const Shot shot = aligned_boxes({1.0, 1.0, 1.0}, {0.5, 0.4, 0.3}, {0.1, 0.05, 0.75});
  return shot;
}
const Shot& deep_by_a_tenth() {
  static const Shot shot = aligned_boxes({1.0, 1.0, 1.0}, {0.5, 0.4, 0.3}, {0.1, 0.05, 0.55});
  return shot;
}
/// By less than a quarter of the thickness of the smaller body.
const Shot& barely_deep() {
  static const Shot shot = aligned_boxes({1.0, 1.0, 1.0}, {0.5, 0.4, 0.3}, {0.1, 0.05, 0.63});
  return shot;
}
const Shot& inside() {
  static const Shot shot = aligned_boxes({1.0, 1.0, 1.0}, {0.5, 0.4, 0.3}, {0.1, 0.05, 0.07});
  return shot;
}

Judgement judge_script(const Script& script, const Shot& shot, const Traits& traits, const Limits& limits = {}) {
  const Case member{.name = "test", .thread = {}, .relation = Relation::none, .shots = {shot}};
  return judge(
      member, traits,
      [&](const Mesh&, const Mesh&) -> std::unique_ptr<Query> {
        if (script.refuses) throw BadMesh("not this one");
        return std::make_unique<Scripted>(script);
      },
      limits);
}

/// All queries, and no limit.
Traits strict() {
  Traits traits;
  traits.answers = {.collide = true, .distance = true, .respond = true};
  traits.law = ResponseLaw::depth;
  return traits;
}
const Traits k_all = strict();

Separation at_distance(double distance) { return {.distance = distance}; }
Response pushing(const Eigen::Vector3d& force) { return {.penalty = 1.0, .force = force}; }

TEST(Judge, RightAnswersAreExact) {
  EXPECT_EQ(judge_script({.collide = false, .distance = at_distance(0.1)}, apart_by_a_tenth(), k_all).worst().verdict,
            Verdict::exact);
  const Response up = pushing(Eigen::Vector3d::UnitZ());
  EXPECT_EQ(judge_script({.collide = true, .distance = at_distance(0.0), .respond = up}, deep_by_a_tenth(), k_all)
                .worst()
                .verdict,
            Verdict::exact);
}

TEST(Judge, AWrongDistanceIsMeasuredInSizes) {
  const Finding found = judge_script({.distance = at_distance(0.2)}, apart_by_a_tenth(), k_all).worst();
  EXPECT_EQ(found.verdict, Verdict::wrong);
  EXPECT_EQ(found.metric, "distance");
  EXPECT_NEAR(found.value, 0.1 / std::sqrt(3.0), 1e-15);
}

TEST(Judge, MissesAndPhantomsAreToldApart) {
  EXPECT_EQ(judge_script({.collide = false}, deep_by_a_tenth(), k_all).worst().metric, "missed");
  EXPECT_EQ(judge_script({.collide = true}, apart_by_a_tenth(), k_all).worst().metric, "phantom");
  EXPECT_EQ(judge_script({.respond = Response{}}, deep_by_a_tenth(), k_all).worst().metric, "missed");
  EXPECT_EQ(judge_script({.respond = pushing(Eigen::Vector3d::UnitX())}, apart_by_a_tenth(), k_all).worst().metric,
            "phantom");
}

TEST(Judge, ADeclaredResolutionExcusesAsMuchAndNoMore) {
  Traits approximate = k_all;
  approximate.approximates = true;
  const auto of_miss = [](double resolution, const Shot& shot, const Traits& traits) {
    return judge_script({.collide = false, .resolution = resolution}, shot, traits).worst().verdict;
  };
  EXPECT_EQ(of_miss(0.11, deep_by_a_tenth(), approximate), Verdict::resolution);
  EXPECT_EQ(of_miss(0.09, deep_by_a_tenth(), approximate), Verdict::wrong);
  // Twice as deep, moved inwards by 0.15 the smaller box vanishes.
  const Shot deeper = aligned_boxes({1.0, 1.0, 1.0}, {0.5, 0.4, 0.3}, {0.1, 0.05, 0.42});
  EXPECT_EQ(of_miss(0.16, deeper, approximate), Verdict::resolution);
  EXPECT_EQ(of_miss(0.14, deeper, approximate), Verdict::wrong);
  // Who does not approximate has no resolution, whatever is counted.
  EXPECT_EQ(of_miss(0.16, deeper, k_all), Verdict::wrong);
}

TEST(Judge, YesWithADistanceIsAContradiction) {
  const Judgement judgement = judge_script({.collide = true, .distance = at_distance(0.1)}, apart_by_a_tenth(), k_all);
  bool seen = false;
  for (const Finding& finding : judgement.findings)
    seen = seen || (finding.metric == "contradiction" && finding.verdict == Verdict::wrong);
  EXPECT_TRUE(seen);
}

TEST(Judge, AForceAsideIsALimitWhereItIsDeclared) {
  Traits own = k_all;
  own.limits.own_direction = true;
  const auto verdict = [](const Eigen::Vector3d& force, const Shot& shot, const Traits& traits) {
    return judge_script({.respond = pushing(force)}, shot, traits).worst().verdict;
  };
  const Eigen::Vector3d aside(1.0, 0.0, 1.0), inwards(0.0, 0.0, -1.0);
  EXPECT_EQ(verdict(inwards, barely_deep(), own), Verdict::wrong);
  EXPECT_EQ(verdict(aside, barely_deep(), own), Verdict::resolution);
  EXPECT_EQ(verdict(aside, barely_deep(), k_all), Verdict::wrong);
  // Deeper, sums of contacts follow their own shortest ways.
  EXPECT_EQ(verdict(aside, deep_by_a_tenth(), own), Verdict::exact);
  EXPECT_EQ(verdict(aside, deep_by_a_tenth(), k_all), Verdict::wrong);
}

TEST(Judge, ADirectionIsJudgedAsSoonAsRoundingLeavesOne) {
  const Shot shallow = aligned_boxes({1.0, 1.0, 1.0}, {0.5, 0.4, 0.3}, {0.1, 0.05, 0.65 - 2e-9});
  ASSERT_TRUE(shallow.truth.push);
  const Eigen::Vector3d tilted(0.01, 0.0, 1.0);
  EXPECT_EQ(judge_script({.respond = pushing(tilted)}, shallow, k_all).worst().verdict, Verdict::wrong);
}

TEST(Judge, WitnessesOfANearlyClosedGapMustLieAcrossIt) {
  const Shot close = aligned_boxes({1.0, 1.0, 1.0}, {0.5, 0.4, 0.3}, {0.1, 0.05, 0.65 + 1e-7});
  const Case member{.name = "test", .thread = {}, .relation = Relation::none, .shots = {close}, .convex = true};
  const auto verdict = [&](const Eigen::Vector3d& between) {
    const Separation gap{.distance = 1e-7, .has_witnesses = true, .witness_b = 1e-7 * between.normalized()};
    return judge(member, k_all,
                 [&](const Mesh&, const Mesh&) { return std::make_unique<Scripted>(Script{.distance = gap}); })
        .worst()
        .verdict;
  };
  EXPECT_LE(verdict({0.0, 0.0, 1.0}), Verdict::resolution);
  EXPECT_EQ(verdict({0.1, 0.0, 1.0}), Verdict::wrong);
}

TEST(Judge, SurfacesOnlyIsALimitWhereBodiesAreInsideEachOther) {
  Traits surfaces = k_all;
  surfaces.limits.surfaces_only = {.collide = true, .respond = true};
  EXPECT_EQ(judge_script({.collide = false, .respond = Response{}}, inside(), surfaces).worst().verdict,
            Verdict::unsupported);
  EXPECT_EQ(judge_script({.collide = false}, inside(), k_all).worst().verdict, Verdict::wrong);
  EXPECT_EQ(judge_script({.collide = false}, deep_by_a_tenth(), surfaces).worst().verdict, Verdict::wrong);
}

TEST(Judge, PointsOfOneBodyMissWhereTheOtherSticksInByLessThanTheResolution) {
  // A box reaches 0.2 into a plate and sticks out of it by 0.02. The plate is B: its surface is 0.02 deep in the box.
  const Shot stands_out = swapped(aligned_boxes({1.0, 1.0, 0.5}, {0.4, 0.4, 0.22}, {0.05, 0.1, 0.16}));
  ASSERT_NEAR(stands_out.truth.depth_of_a, 0.2, 1e-15);
  ASSERT_NEAR(stands_out.truth.depth_of_b, 0.02, 1e-15);
  Traits all = k_all;
  all.approximates = true;
  Traits points = all;
  points.limits.only_points_of_b = true;
  const auto verdict = [](const Shot& shot, const Traits& traits, double resolution) {
    return judge_script({.respond = Response{}, .resolution = resolution}, shot, traits).worst().verdict;
  };
  EXPECT_EQ(verdict(stands_out, points, 0.03), Verdict::resolution);
  EXPECT_EQ(verdict(stands_out, points, 0.001), Verdict::wrong);
  EXPECT_EQ(verdict(stands_out, all, 0.03), Verdict::wrong);
  EXPECT_EQ(verdict(swapped(stands_out), points, 0.03), Verdict::wrong);
  EXPECT_EQ(verdict(deep_by_a_tenth(), points, 0.03), Verdict::wrong);
}

TEST(Judge, ADistanceOfBodiesIsALimitWhereTheyAreInsideEachOther) {
  Shot known = inside();
  known.truth.distance = 0.2;
  Traits bodies = k_all;
  EXPECT_EQ(judge_script({.distance = at_distance(0.0)}, known, bodies).worst().verdict, Verdict::wrong);
  bodies.limits.distance_of_bodies = true;
  EXPECT_EQ(judge_script({.distance = at_distance(0.0)}, known, bodies).worst().verdict, Verdict::unsupported);
  EXPECT_EQ(judge_script({.distance = at_distance(0.1)}, known, bodies).worst().verdict, Verdict::wrong);
}

TEST(Judge, WaysToGiveNoAnswerAreKeptApart) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(judge_script({.distance = at_distance(nan)}, apart_by_a_tenth(), k_all).worst().verdict,
            Verdict::non_finite);
  const Finding threw = judge_script({.throws = true}, apart_by_a_tenth(), k_all).worst();
  EXPECT_EQ(threw.verdict, Verdict::threw);
  EXPECT_EQ(threw.words, "assertion of a library");
  EXPECT_EQ(judge_script({.collide = Status::failed}, apart_by_a_tenth(), k_all).worst().verdict, Verdict::threw);
  const Finding refused = judge_script({.refuses = true}, apart_by_a_tenth(), k_all).worst();
  EXPECT_EQ(refused.verdict, Verdict::unsupported);
  EXPECT_EQ(refused.words, "not this one");
  EXPECT_EQ(judge_script({}, apart_by_a_tenth(), k_all).worst().metric, "none");
  EXPECT_EQ(judge_script({.collide = false, .delay = std::chrono::milliseconds(30)}, apart_by_a_tenth(), k_all,
                         {.seconds = 0.01})
                .worst()
                .verdict,
            Verdict::hung);
}

TEST(Judge, AnOpenMeshMayBeRefusedByAQuery) {
  Shot open = apart_by_a_tenth();
  open.a = triangles({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}});
  open.truth = {};
  EXPECT_EQ(judge_script({.respond = Status::failed}, open, k_all).worst().verdict, Verdict::unsupported);
}

TEST(Judge, AnAnswerToAPoseThatIsNoneIsWrong) {
  Shot bad = apart_by_a_tenth();
  bad.truth = {};
  bad.raw = bad.X_AB.pose();
  bad.raw->t.x() = std::numeric_limits<double>::quiet_NaN();
  const Case member{.name = "test", .thread = {}, .relation = Relation::bad, .shots = {bad}};
  const auto judged = [&](const Script& script) {
    return judge(member, k_all, [&](const Mesh&, const Mesh&) { return std::make_unique<Scripted>(script); })
        .worst()
        .verdict;
  };
  EXPECT_EQ(judged({.collide = false}), Verdict::wrong);
  EXPECT_EQ(judged({.collide = Status::failed}), Verdict::exact);
  EXPECT_EQ(judged({.collide = Status::non_finite}), Verdict::exact);
}

TEST(Judge, ANoAtDistanceZeroIsAContradictionAlsoWhereNoTruthIsGiven) {
  Shot unknown = apart_by_a_tenth();
  unknown.truth = {};
  const Script script{.collide = false, .distance = at_distance(0.0)};
  EXPECT_EQ(judge_script(script, unknown, k_all).worst().metric, "contradiction");
  EXPECT_EQ(judge_script(script, unknown, k_all).worst().verdict, Verdict::wrong);
}

TEST(Judge, AMissAfterTheContactOfASweepIsWrong) {
  const Shot start = apart_by_a_tenth();
  const Case falling{.name = "test",
                     .thread = {},
                     .relation = Relation::sweep,
                     .shots = {start},
                     .convex = true,
                     .motion = {0.0, 0.0, -1.0},
                     .contact_time = start.truth.gap};
  Traits yes_no = k_all;
  yes_no.answers = {.collide = true};
  const auto judged = [&](const Script& script, const Traits& traits) {
    return judge(falling, traits, [&](const Mesh&, const Mesh&) { return std::make_unique<Scripted>(script); });
  };
  EXPECT_EQ(judged({.collide = false}, yes_no).worst().metric, "missed");
  EXPECT_EQ(judged({.collide = false}, yes_no).worst().verdict, Verdict::wrong);
  EXPECT_EQ(judged({.distance = Status::failed}, k_all).worst().verdict, Verdict::threw);
}

TEST(Judge, AFarPoseMustBeAnswered) {
  Shot far = apart_by_a_tenth();
  far.X_AB.t.x() = 1e150;
  far.truth = {};
  far.truth.gap = far.truth.distance = 1e150;
  const Case member{.name = "test", .thread = {}, .relation = Relation::bad, .shots = {far}};
  const auto judged = [&](const Script& script) {
    return judge(member, k_all, [&](const Mesh&, const Mesh&) { return std::make_unique<Scripted>(script); })
        .worst()
        .verdict;
  };
  EXPECT_EQ(judged({.collide = false, .distance = at_distance(1e150)}), Verdict::exact);
  EXPECT_EQ(judged({.collide = false, .distance = Status::failed}), Verdict::threw);
  EXPECT_EQ(judged({.collide = true}), Verdict::wrong);
}

}  // namespace
}  // namespace sixdof::stability
