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

Judgement judge_script(const Script& script, const Shot& shot, const Profile& profile, const Limits& limits = {}) {
  const Case member{.name = "test", .thread = {}, .relation = Relation::none, .shots = {shot}};
  return judge(
      member, profile,
      [&](const Mesh&, const Mesh&) -> std::unique_ptr<Query> {
        if (script.refuses) throw BadMesh("not this one");
        return std::make_unique<Scripted>(script);
      },
      limits);
}

const Profile k_all{.answers = {.collide = true, .distance = true, .respond = true}, .law = ResponseLaw::depth};

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
  // Moved inwards by volume / area = 0.0638 the smaller box vanishes.
  EXPECT_EQ(judge_script({.collide = false, .resolution = 0.07}, deep_by_a_tenth(), k_all).worst().verdict,
            Verdict::resolution);
  EXPECT_EQ(judge_script({.collide = false, .resolution = 0.06}, deep_by_a_tenth(), k_all).worst().verdict,
            Verdict::wrong);
}

TEST(Judge, YesWithADistanceIsAContradiction) {
  const Judgement judgement = judge_script({.collide = true, .distance = at_distance(0.1)}, apart_by_a_tenth(), k_all);
  bool seen = false;
  for (const Finding& finding : judgement.findings)
    seen = seen || (finding.metric == "contradiction" && finding.verdict == Verdict::wrong);
  EXPECT_TRUE(seen);
}

TEST(Judge, AForceThatPullsInIsWrongAndOneAsideIsTheLaws) {
  EXPECT_EQ(judge_script({.respond = pushing(-Eigen::Vector3d::UnitZ())}, barely_deep(), k_all).worst().verdict,
            Verdict::wrong);
  const Eigen::Vector3d aside(1.0, 0.0, 1.0);
  EXPECT_EQ(judge_script({.respond = pushing(aside)}, barely_deep(), k_all).worst().verdict, Verdict::resolution);
  Profile exact = k_all;
  exact.law = ResponseLaw::volume;
  EXPECT_EQ(judge_script({.respond = pushing(aside)}, barely_deep(), exact).worst().verdict, Verdict::wrong);
  // Deeper, laws of points follow their own shortest ways; the gradient of the volume is what it is.
  EXPECT_EQ(judge_script({.respond = pushing(aside)}, deep_by_a_tenth(), k_all).worst().verdict, Verdict::exact);
  EXPECT_EQ(judge_script({.respond = pushing(aside)}, deep_by_a_tenth(), exact).worst().verdict, Verdict::wrong);
}

TEST(Judge, SurfacesOnlyIsALimitWhereBodiesAreInsideEachOther) {
  Profile surfaces = k_all;
  surfaces.finds_contained = surfaces.pushes_contained = false;
  EXPECT_EQ(judge_script({.collide = false, .respond = Response{}}, inside(), surfaces).worst().verdict,
            Verdict::unsupported);
  EXPECT_EQ(judge_script({.collide = false}, inside(), k_all).worst().verdict, Verdict::wrong);
  EXPECT_EQ(judge_script({.collide = false}, deep_by_a_tenth(), surfaces).worst().verdict, Verdict::wrong);
}

TEST(Judge, ADistanceOfBodiesIsALimitWhereTheyAreInsideEachOther) {
  Shot known = inside();
  known.truth.distance = 0.2;
  Profile bodies = k_all;
  EXPECT_EQ(judge_script({.distance = at_distance(0.0)}, known, bodies).worst().verdict, Verdict::wrong);
  bodies.distance_of_bodies = true;
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

TEST(Judge, TheReferenceFindsBodiesInsideEachOther) {
  const Profile profile = exact_profile();
  EXPECT_TRUE(profile.finds_contained);
  EXPECT_TRUE(profile.pushes_contained);
  EXPECT_FALSE(profile.distance_of_bodies);
  const std::unique_ptr<Algorithm> surfaces = make_brute_force_algorithm();
  const auto prepare = [&](const Mesh& a, const Mesh& b) { return surfaces->prepare(a, b, surfaces->settings()); };
  EXPECT_FALSE(profile_of(surfaces->traits(), prepare).finds_contained);
}

}  // namespace
}  // namespace sixdof::stability
