#include <sixdof/stability/ray_algorithm.h>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/stability/bodies.h>
#include <sixdof/stability/families.h>
#include <sixdof/stability/shots.h>

namespace sixdof::stability {
namespace {

void ignore(const Pose&) {}

Judgement judged(const RayAlgorithm& algorithm, const Case& member) { return algorithm.judge_rays(member, ignore); }

/// The ray cast with its translations changed.
class Changed final : public RaySolver {
 public:
  using Change = std::function<void(std::span<const double> targets, std::span<double> translations)>;
  Changed(std::unique_ptr<RaySolver> inner, Change change) : inner_(std::move(inner)), change_(std::move(change)) {}
  void set_rotation(const Eigen::Vector4d& rotation) override { inner_->set_rotation(rotation); }
  void solve(const Eigen::Vector3d& direction, std::span<const double> targets, std::span<double> translations,
             std::span<double> residuals) override {
    inner_->solve(direction, targets, translations, residuals);
    change_(targets, translations);
  }
  std::uint64_t measurements() const override { return inner_->measurements(); }

 private:
  std::unique_ptr<RaySolver> inner_;
  Change change_;
};

RayAlgorithm changed(const Changed::Change& change) {
  return {TargetKind::distance, "changed", [change](const Mesh& a, const Mesh& b) {
            return std::make_unique<Changed>(make_ray_cast()->prepare(a, b), change);
          }};
}

Case over_a_face() {
  const Shot shot = aligned_boxes({2.0, 1.6, 1.2}, {0.7, 0.5, 0.4}, {0.3, 0.2, 1.1});
  return {.name = "test", .thread = {}, .relation = Relation::same, .shots = {shot, swapped(shot), scaled(shot, 1e4)}};
}

TEST(RayAlgorithm, TheGeneratorsHaveNoRedCell) {
  constexpr std::size_t k_samples = 3;
  for (const TargetKind kind : {TargetKind::distance, TargetKind::volume}) {
    const RayAlgorithm generator(kind);
    std::size_t exact = 0;
    for (const Family& family : families()) {
      for (std::size_t i = 0; i < k_samples; ++i) {
        const Genes genes = sample_genes(family, 31, i, k_samples);
        Draw draw(genes);
        const Finding worst = judged(generator, family.make(draw)).worst();
        EXPECT_LE(worst.verdict, Verdict::unsupported)
            << generator.traits().name << " on " << family.name << " " << i << ": " << to_string(worst.verdict) << " "
            << worst.metric << " " << worst.value << ", shot " << worst.shot << ": " << worst.words;
        if (worst.verdict <= Verdict::resolution) ++exact;
      }
    }
    EXPECT_GT(exact, 40u) << generator.traits().name;
  }
}

TEST(RayAlgorithm, AFalseTranslationIsSeen) {
  const auto metric_of = [](const Changed::Change& change) {
    const Finding worst = judged(changed(change), over_a_face()).worst();
    EXPECT_EQ(worst.verdict, Verdict::wrong) << worst.metric;
    return worst.metric;
  };
  EXPECT_EQ(metric_of([](auto, auto found) { found[0] *= 1.0 + 1e-6; }), "target");
  // Far inside: the target is met farther out.
  EXPECT_EQ(metric_of([](auto, auto found) { found[1] *= 0.5; }), "target");
  EXPECT_EQ(metric_of([](auto, auto found) { found[1] = std::numeric_limits<double>::quiet_NaN(); }), "missed hit");
}

/// A hook: a small box behind a wall and one before it. The wall's far side has the distance of the near side, too.
TEST(RayAlgorithm, AHitBehindTheFirstIsSeen) {
  const Shot shot = aligned_boxes({0.1, 2.0, 2.0}, {0.3, 0.25, 0.2}, {1.0, 0.0, 0.0});
  const Case member{.name = "test", .thread = {}, .relation = Relation::none, .shots = {shot}};
  // Off the centre, so that the far side is met before s = 0.
  const RayAlgorithm far_side(TargetKind::distance, "far", [](const Mesh& a, const Mesh& b) {
    return std::make_unique<Changed>(make_ray_cast()->prepare(a, b), [](auto, auto found) { found[0] = -found[0]; });
  });
  const Finding worst = judged(far_side, member).worst();
  EXPECT_EQ(worst.verdict, Verdict::wrong);
  EXPECT_EQ(worst.metric, "earlier hit");
}

TEST(RayAlgorithm, AChangeFromSolverToSolverIsSeen) {
  auto calls = std::make_shared<int>(0);
  const auto drifting = changed([calls](auto, auto found) { found[0] += 1e-15 * (*calls)++; });
  bool seen = false;
  for (const Finding& finding : judged(drifting, over_a_face()).findings)
    seen = seen || (finding.metric == "second object" && finding.verdict == Verdict::wrong);
  EXPECT_TRUE(seen);
}

TEST(RayAlgorithm, WhatIsThrownIsAVerdict) {
  EXPECT_EQ(judged(changed([](auto, auto) { throw Error("no hit"); }), over_a_face()).worst().verdict, Verdict::threw);
  Case open = over_a_face();
  open.shots.resize(1);
  open.shots.front().a = triangles({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}});
  EXPECT_EQ(judged(RayAlgorithm(TargetKind::volume), open).worst().verdict, Verdict::unsupported);
  EXPECT_LE(judged(RayAlgorithm(TargetKind::distance), open).worst().verdict, Verdict::resolution);
}

TEST(RayAlgorithm, AnswersNoQuery) {
  const Mesh body = *box({1.0, 1.0, 1.0});
  const RayAlgorithm generator(TargetKind::distance);
  EXPECT_THROW(generator.prepare(body, body, generator.settings()), BadArgument);
}

}  // namespace
}  // namespace sixdof::stability
