#include <sixdof/results/choice.h>

#include <chrono>

#include <gtest/gtest.h>

#include <sixdof/models/model_catalogue.h>

#include "bench/study/precision.h"

#include "../configuration/small_suite.h"

namespace sixdof::study {
namespace {

constexpr double k_rounding = 1e-6;  // of one quotient

void wait(int microseconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(microseconds);
  while (std::chrono::steady_clock::now() < end) {
  }
}

/// Takes a time and answers with an error in the distance that both follow from its resolution: fine is slow and exact.
class TunableQuery final : public Query {
 public:
  TunableQuery(const Mesh& a, const Mesh&, const Settings& settings)
      : steps_(settings.number("steps")), diagonal_(a.diagonal()) {}

  Outcome<Separation> distance(const Pose&) override {
    wait(static_cast<int>(20 * steps_));
    return Separation{.distance = 0.05 * diagonal_ * (1.0 + 1.0 / steps_)};
  }

 private:
  const double steps_;
  const double diagonal_;
};

/// Takes 3 ms, but 20 us with a warm start if B is near where it was before. There it fails if `fails` is set.
class WarmQuery final : public Query {
 public:
  WarmQuery(const Mesh& a, const Mesh&, const Settings& settings)
      : near_(settings.choice("warm_start") == "on" ? 1e-3 * a.diagonal() : 0.0), target_(0.05 * a.diagonal()) {}

  Outcome<Separation> distance(const Pose& X_AB) override {
    const bool is_near = (X_AB.t - last_.t).norm() < near_;
    last_ = X_AB;
    wait(is_near ? 20 : 3'000);
    if (is_near && fails) return Status::failed;
    return Separation{.distance = target_};
  }

  static inline bool fails = false;

 private:
  const double near_, target_;
  Pose last_;
};

std::unique_ptr<Algorithm> tunable(const std::string& name, std::vector<std::string> steps) {
  return make_algorithm<TunableQuery>({.name = name,
                                       .answers = {.distance = true},
                                       .parameters = {Parameter::count("steps", "steps", "1", 1, 1e6).swept(steps)}});
}

class Recommend : public ::testing::Test {
 protected:
  /// A query takes 20 us a step.
  results::Choice within(double deadline_s) {
    PrecisionPlan plan{.question = bench::QueryKind::distance, .algorithms = algorithms_};
    plan.values = warm_starts(algorithms_, {});
    plan.error = "error_rms";
    plan.single_queries = true;
    plan.deadline_ns = 1e9 * deadline_s;
    plan.rounds = 1;
    plan.most_rounds = 1;
    study_ = std::make_unique<PrecisionStudy>(plan, cache_, pair_, sample_);
    study_->run([](const std::string&, std::size_t, std::size_t) {}, [] {});
    return results::choose(study_->rows(), plan.error, 1e9 * deadline_s);
  }
  std::string name(const std::optional<results::Candidate>& candidate) const {
    if (!candidate) return "none";
    const PrecisionPoint& point = study_->points()[candidate->place];
    return point.algorithm->traits().name + " " + point.sweep.assignments.front();
  }

  std::unique_ptr<Algorithm> fine_ = tunable("fine", {"2", "20", "200", "400"});
  std::unique_ptr<Algorithm> coarse_ = tunable("coarse", {"3", "10"});
  std::vector<const Algorithm*> algorithms_{fine_.get(), coarse_.get()};
  bench::PairCache cache_{32, 1, [](const std::string& key) { return bench::LoadedMesh{load_model(key), key}; }};
  SetCatalogue catalogue_ = SetCatalogue::read(std::filesystem::path(SIXDOF_SMALL_SUITE) / "manifest.json");
  const CatalogueEntry& pair_ = catalogue_.sets().front();
  StudySample sample_ = draw_sample(cache_, pair_, bench::QueryKind::distance, {{BucketKind::distance, 5}}, 32);
  std::unique_ptr<PrecisionStudy> study_;
};

TEST_F(Recommend, TakesTheSmallestErrorThatKeepsTheDeadline) {
  const results::Choice found = within(2e-3);
  EXPECT_EQ(found.tail, "max") << "32 queries have no p99";
  EXPECT_EQ(name(found.best), "fine steps=20");
  EXPECT_EQ(name(found.second), "coarse steps=10");
  EXPECT_NEAR(found.best->error.value, 0.05 / 20, k_rounding);
  EXPECT_GE(found.best->tail_ns, 20 * 20e3);
  EXPECT_LE(found.best->tail_ns, 2e6);
  EXPECT_GE(found.best->tail_once_ns, found.best->tail_ns);
  // Half of its first queries are over the deadline, so the finer ones are not tried.
  EXPECT_NE(study_->points()[2].left_out.find("over the deadline"), std::string::npos) << study_->points()[2].left_out;
  EXPECT_EQ(study_->points()[3].left_out, study_->points()[2].left_out);
}

TEST_F(Recommend, TakesNoneWhereNoneKeepsIt) {
  const results::Choice found = within(30e-6);
  EXPECT_FALSE(found.best);
  EXPECT_FALSE(found.second);
}

/// With motions from the sample's configurations.
class RecommendInMotion : public Recommend {
 protected:
  RecommendInMotion() {
    algorithms_ = {warm_.get(), coarse_.get()};
    sample_.motions = draw_motions(sample_, cache_.mesh(pair_.a), cache_.mesh(pair_.b), 1);
  }
  ~RecommendInMotion() override { WarmQuery::fails = false; }

  std::unique_ptr<Algorithm> warm_ = make_algorithm<WarmQuery>(
      {.name = "warm",
       .answers = {.distance = true},
       .parameters = {Parameter::choice("warm_start", "from the last answer", "off", {"off", "on"})}});
};

TEST_F(RecommendInMotion, HasAsManyTimesThatCountAsConfigurations) {
  std::size_t counted = 0;
  for (std::size_t i = 0; i < sample_.motions.poses.size(); ++i) counted += sample_.motions.counts(i) ? 1 : 0;
  EXPECT_GE(counted, sample_.poses.size());
  EXPECT_LT(counted, sample_.poses.size() + sample_.motions.period);
  EXPECT_FALSE(sample_.motions.counts(0)) << "where B has jumped to";
  EXPECT_EQ(sample_.motions.poses[0].t, sample_.poses[0].t);
}

TEST_F(RecommendInMotion, TakesWhatIsFastFromPoseToPose) {
  const results::Choice found = within(1e-3);
  EXPECT_EQ(name(found.best), "warm warm_start=on");
  EXPECT_NE(study_->points()[1].left_out.find("over the deadline"), std::string::npos) << "without a warm start";
  sample_.motions = {};
  const results::Choice apart = within(1e-3);
  EXPECT_EQ(name(apart.best), "coarse steps=10") << "where poses are far apart";
}

TEST_F(RecommendInMotion, TakesNothingThatFailsOnTheWay) {
  WarmQuery::fails = true;
  const results::Choice found = within(1e-3);
  EXPECT_EQ(name(found.best), "coarse steps=10");
  const PrecisionPoint& point = study_->points()[0];
  EXPECT_TRUE(point.faulty());
  EXPECT_EQ(point.metric("failed")->value, static_cast<double>(point.errors.failed));
  EXPECT_GE(point.errors.failed, sample_.poses.size());
}

}  // namespace
}  // namespace sixdof::study
