#include <sixdof/results/choice.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>

#include <gmock/gmock.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/base/error.h>
#include <sixdof/models/model_catalogue.h>

#include "bench/study/cast_study.h"
#include "bench/study/precision.h"
#include "bench/study/verdict_sample.h"

#include "../configuration/small_suite.h"

namespace sixdof::study {
namespace {

constexpr double k_rounding = 1e-6;  // of one quotient

/// For a test to be skipped. Measured here, without the code under test: whether a loop that only looks at the clock is
/// interrupted for longer than a query may be.
bool machine_is_busy() {
  using Clock = std::chrono::steady_clock;
  auto last = Clock::now();
  for (const auto end = last + std::chrono::milliseconds(200); last < end;) {
    const auto now = Clock::now();
    if (now - last > std::chrono::milliseconds(1)) return true;
    last = now;
  }
  return false;
}

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
                                       .approximates = true,
                                       .parameters = {Parameter::count("steps", "steps", "1", 1, 1e6).swept(steps)}});
}

class Recommend : public ::testing::Test {
 protected:
  /// A query of the tunable ones takes 20 us a step.
  results::Choice within(double deadline_s) {
    PrecisionPlan plan{.question = sample_.question, .algorithms = algorithms_};
    plan.values = warm_starts(algorithms_, {});
    plan.error = sample_.question == bench::QueryKind::collide ? "mismatch" : "error_max";
    plan.single_queries = true;
    plan.deadline_ns = 1e9 * deadline_s;
    plan.rounds = 1;
    plan.most_rounds = 1;
    study_ = std::make_unique<PrecisionStudy>(plan, cache_, pair_, sample_);
    study_->run([](const std::string&, std::size_t, std::size_t) {}, [] {});
    return results::choose(study_->rows(), std::string(to_string(sample_.question)), plan.error);
  }
  /// The same, again while single queries are late: on a machine that does other work some are, by chance.
  results::Choice undisturbed(double deadline_s) {
    constexpr int k_tries = 8;
    const auto is_late = [](const auto& each) { return each.reason.find(" late") != std::string::npos; };
    results::Choice found = within(deadline_s);
    for (int i = 1; i < k_tries && std::ranges::any_of(found.candidates, is_late); ++i) found = within(deadline_s);
    return found;
  }
  std::string name(const results::Candidate* candidate) const {
    if (candidate == nullptr) return "none";
    const PrecisionPoint& point = study_->points()[candidate->place];
    return point.algorithm->traits().name +
           (point.sweep.assignments.empty() ? "" : " " + point.sweep.assignments.front());
  }
  const results::Candidate& candidate(const results::Choice& choice, const std::string& wanted) const {
    return *std::ranges::find_if(choice.candidates, [&](const auto& each) { return name(&each) == wanted; });
  }

  std::unique_ptr<Algorithm> fine_ = tunable("fine", {"2", "20", "200", "400"});
  std::unique_ptr<Algorithm> coarse_ = tunable("coarse", {"3", "10"});
  std::vector<const Algorithm*> algorithms_{fine_.get(), coarse_.get()};
  bench::PairCache cache_{0, 1, [](const std::string& key) { return bench::LoadedMesh{load_model(key), key}; }};
  SetCatalogue catalogue_ = SetCatalogue::read(std::filesystem::path(SIXDOF_SMALL_SUITE) / "manifest.json");
  const CatalogueEntry& pair_ = catalogue_.sets().front();
  StudySample sample_ = draw_sample(cache_, pair_, bench::QueryKind::distance, {{BucketKind::distance, 5}}, 32);
  std::unique_ptr<PrecisionStudy> study_;
};

TEST_F(Recommend, TakesTheSmallestErrorThatKeepsTheDeadline) {
  if (machine_is_busy()) GTEST_SKIP() << "other work interrupts loops: queries would be late";
  const results::Choice found = undisturbed(2e-3);
  ASSERT_EQ(name(found.taken()), "fine steps=20");
  EXPECT_NEAR(found.taken()->error.value, 0.05 / 20, k_rounding);
  EXPECT_FALSE(found.taken()->exact);
  EXPECT_EQ(found.taken()->timed, 32);
  EXPECT_EQ(candidate(found, "coarse steps=10").standing, results::Standing::less_right);
  EXPECT_EQ(candidate(found, "coarse steps=10").reason, "larger error");
  // Half of its first queries are over the deadline, so the finer ones are not tried.
  EXPECT_EQ(candidate(found, "fine steps=200").standing, results::Standing::left_out);
  EXPECT_NE(study_->points()[2].left_out.find("over the deadline"), std::string::npos) << study_->points()[2].left_out;
  EXPECT_EQ(study_->points()[3].left_out, study_->points()[2].left_out);
}

TEST_F(Recommend, TakesNoneWhereNoneKeepsIt) {
  const results::Choice found = within(30e-6);
  EXPECT_EQ(found.taken(), nullptr);
  EXPECT_EQ(found.missing, "") << "the poses would do";
}

/// How an algorithm with one planted fault goes wrong.
enum class Plant {
  yes,            ///< Always says yes,
  no,             ///< or no.
  seldom,         ///< Wrong at 1 % of the poses.
  near,           ///< Wrong within 0.1 % of A's diagonal of contact, bodies apart.
  deep,           ///< Wrong where more than 0.5 % of A's volume overlap.
  sometimes_slow  ///< Right, and takes 3 ms at every 500th query.
};
constexpr Plant k_plants[] = {Plant::yes, Plant::no, Plant::seldom, Plant::near, Plant::deep, Plant::sometimes_slow};
constexpr int k_planted = 100;

/// Right but for its fault; the number chooses the poses.
class PlantedQuery final : public Query {
 public:
  PlantedQuery(const Mesh& a, const Mesh& b, Plant plant, unsigned number)
      : exact_(prepared(a, b)), plant_(plant), number_(number), diagonal_(a.diagonal()), volume_(a.volume()) {}

  Outcome<bool> collide(const Pose& X_AB) override {
    if (plant_ == Plant::yes || plant_ == Plant::no) return plant_ == Plant::yes;
    if (plant_ == Plant::sometimes_slow && (++asked_ + number_) % 500 == 0) wait(3'000);
    const bool right = exact_->collide(X_AB).value;
    return is_wrong(X_AB, right) ? !right : right;
  }

 private:
  static std::unique_ptr<Query> prepared(const Mesh& a, const Mesh& b) {
    static const std::unique_ptr<Algorithm> algorithm = make_exact_algorithm();
    return algorithm->prepare(a, b, algorithm->settings());
  }
  bool is_wrong(const Pose& X_AB, bool right) {
    if (plant_ == Plant::seldom) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &X_AB.t.x(), sizeof bits);
      return std::hash<std::uint64_t>{}(bits ^ (bits >> 29) ^ number_) % 100 == number_ % 100;
    }
    if (plant_ == Plant::near) return !right && exact_->distance(X_AB).value.distance < 1e-3 * diagonal_;
    return plant_ == Plant::deep && right && exact_->respond(X_AB).value.volume > 5e-3 * volume_;
  }

  std::unique_ptr<Query> exact_;
  const Plant plant_;
  const unsigned number_;
  const double diagonal_, volume_;
  unsigned asked_ = 0;
};

class PlantedAlgorithm final : public Algorithm {
 public:
  PlantedAlgorithm(Plant plant, unsigned number)
      : traits_{.name = "planted-" + std::to_string(number),
                .version = "1",
                .summary = "wrong in one way",
                .answers = {.collide = true},
                .parameters = {}},
        plant_(plant),
        number_(number) {}
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& /*settings*/) const override {
    return std::make_unique<PlantedQuery>(a, b, plant_, number_);
  }
  Plant plant() const { return plant_; }

 private:
  const Traits traits_;
  const Plant plant_;
  const unsigned number_;
};

void expect_reason(Plant plant, const results::Candidate& candidate) {
  using ::testing::HasSubstr;
  using ::testing::Not;
  SCOPED_TRACE(candidate.reason);
  if (plant == Plant::sometimes_slow) {
    EXPECT_THAT(candidate.reason, HasSubstr("queries late"));
    const bool noisy = candidate.standing == results::Standing::undecided;  // the machine, while this test ran
    EXPECT_TRUE(noisy || candidate.standing == results::Standing::late);
    EXPECT_EQ(noisy, candidate.reason.find("the loop that asks nothing") != std::string::npos);
    return;
  }
  EXPECT_EQ(candidate.standing, results::Standing::unsafe);
  const bool apart = plant == Plant::yes || plant == Plant::seldom,
             deep = plant == Plant::no || plant == Plant::seldom || plant == Plant::deep;
  EXPECT_THAT(candidate.reason,
              apart ? testing::Matcher<const std::string&>(HasSubstr("apart ")) : Not(HasSubstr("(apart ")));
  EXPECT_THAT(candidate.reason,
              deep ? testing::Matcher<const std::string&>(HasSubstr("overlapping ")) : Not(HasSubstr("overlapping ")));
  if (plant == Plant::near) {
    EXPECT_THAT(candidate.reason, HasSubstr("(near contact "));
  }
}

TEST_F(Recommend, TakesNoneOfAHundredPlantedFaults) {
  sample_ = draw_verdict_sample(cache_, pair_, bench::QueryKind::collide, 2100);
  std::vector<std::unique_ptr<PlantedAlgorithm>> planted;
  algorithms_.clear();
  for (unsigned i = 0; i < k_planted; ++i) {
    planted.push_back(std::make_unique<PlantedAlgorithm>(k_plants[i % std::size(k_plants)], i));
    algorithms_.push_back(planted.back().get());
  }
  const results::Choice found = within(1e-3);
  EXPECT_EQ(found.taken(), nullptr);
  const bool noisy = std::ranges::any_of(
      found.candidates, [](const results::Candidate& each) { return each.standing == results::Standing::undecided; });
  EXPECT_EQ(found.missing.find("the machine is too noisy for the deadline") == 0, noisy) << found.missing;
  EXPECT_EQ(found.missing.empty(), !noisy);
  ASSERT_EQ(found.candidates.size(), planted.size());
  for (const results::Candidate& each : found.candidates) expect_reason(planted[each.place]->plant(), each);
}

/// `exact`, but contacts in the middle of a motion are off by `shift` of the motion.
class ShiftedCasts final : public Algorithm {
 public:
  ShiftedCasts(std::string name, double shift) : shift_(shift) { traits_.name = std::move(name); }
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings&) const override {
    class ShiftedQuery final : public Query {
     public:
      ShiftedQuery(std::unique_ptr<Query> exact, double shift) : exact_(std::move(exact)), shift_(shift) {}
      Outcome<Impact> cast(const Motion& motion) override {
        Outcome<Impact> answer = exact_->cast(motion);
        // Where there is room for the shift.
        if (answer.ok() && answer.value.hit && answer.value.t > 0.3 && answer.value.t < 0.7) answer.value.t += shift_;
        return answer;
      }

     private:
      const std::unique_ptr<Query> exact_;
      const double shift_;
    };
    return std::make_unique<ShiftedQuery>(exact_->prepare(a, b, exact_->settings()), shift_);
  }

 private:
  const double shift_;
  const std::unique_ptr<Algorithm> exact_ = make_exact_algorithm();
  Traits traits_{.answers = {.cast = true}};
};

TEST_F(Recommend, LateContactsAreUnsafeAndEarlyOnesLessRight) {
  const CastSample sample = draw_cast_sample(cache_, pair_, 90, 1);
  EXPECT_GT(sample.hits(), 30u);
  EXPECT_LT(sample.hits(), sample.motions.size());
  ShiftedCasts right("right", 0.0), late("late", 0.01), early("early", -0.01);
  const CastPlan plan{.algorithms = {&right, &late, &early}, .values = {}, .deadline_ns = 1e10};
  std::size_t steps = 0;
  const std::vector<CastPoint> points = measure_casts(
      plan, cache_, pair_, sample, [](const std::string&, std::size_t, std::size_t) {},
      [&](const std::vector<CastPoint>& done) { EXPECT_EQ(done.size(), ++steps); });
  std::vector<results::Row> rows;
  for (const CastPoint& point : points) rows.push_back(point.row);
  const results::Choice found = results::choose(rows, results::k_cast, "early_max");
  ASSERT_TRUE(found.missing.empty()) << found.missing;
  std::map<std::string, const results::Candidate*> by_name;
  for (const results::Candidate& each : found.candidates) by_name[rows[each.place].fields.algorithm] = &each;
  EXPECT_EQ(found.taken(), by_name.at("right"));
  EXPECT_EQ(by_name.at("late")->standing, results::Standing::unsafe);
  EXPECT_THAT(by_name.at("late")->reason, ::testing::HasSubstr("late)"));
  EXPECT_EQ(by_name.at("early")->standing, results::Standing::less_right);
  EXPECT_NEAR(rows[2].value("early_max").value(), 0.01, 1e-6);  // the resolution of `exact` and the bracket
}

TEST_F(Recommend, NoContactsNoVerdict) {
  CatalogueEntry without = pair_;
  std::erase(without.buckets, bench::k_contact);
  EXPECT_THROW(draw_cast_sample(cache_, without, 90, 1), BadArgument);
}

TEST_F(Recommend, SaysNothingWithoutJudgedOverlaps) {
  sample_ = draw_sample(cache_, pair_, bench::QueryKind::collide, {{BucketKind::distance, 5}}, 64);
  const auto exact = make_exact_algorithm();
  algorithms_ = {exact.get()};
  const results::Choice found = within(1e-3);
  EXPECT_EQ(found.taken(), nullptr);
  EXPECT_EQ(found.missing,
            "there are 0 of the 30 poses near contact that it needs, and 0 of the 30 poses overlapping that it needs");
  EXPECT_EQ(found.candidates.at(0).standing, results::Standing::not_ranked);
}

TEST_F(Recommend, PosesNearContactAreWhatTheySay) {
  const CatalogueEntry& pair = *std::ranges::find(catalogue_.sets(), "torus-1k-cone-1k", &CatalogueEntry::pair);
  const StudySample sample = draw_verdict_sample(cache_, pair, bench::QueryKind::collide, 900);
  const auto exact = make_exact_algorithm();
  const Mesh &a = cache_.mesh(pair.a), &b = cache_.mesh(pair.b);
  ASSERT_LT(b.diagonal(), 0.9 * a.diagonal());
  const auto query = exact->prepare(a, b, exact->settings());
  constexpr double k_largest_gap = 3e-3 + 1e-9;  // of the smaller body's diagonal, and rounding
  std::size_t near_apart = 0, near_overlapping = 0;
  for (std::size_t i = 0; i < sample.poses.size(); ++i) {
    const Reference& reference = sample.references[i];
    const bool overlap = reference.known.key.kind == BucketKind::volume;
    EXPECT_EQ(query->collide(sample.poses[i]).value, overlap);
    if (reference.nearness != Nearness::near) continue;
    (overlap ? near_overlapping : near_apart) += 1;
    if (!overlap) {
      EXPECT_LE(query->distance(sample.poses[i]).value.distance, k_largest_gap * b.diagonal());
    } else {
      EXPECT_LT(query->respond(sample.poses[i]).value.volume, 0.01 * a.volume()) << "pushed in by 0.3 % at most";
    }
  }
  EXPECT_GT(near_apart, 100u);
  EXPECT_GT(near_overlapping, 100u);
}

TEST_F(Recommend, EveryPoseIsMovedToEveryGapOnce) {
  // Fewer than there are gaps by one: counting through both at once would give each pose the same gap again.
  constexpr std::size_t k_poses = 5;
  bench::PairCache few{k_poses, 1, [](const std::string& key) { return bench::LoadedMesh{load_model(key), key}; }};
  const StudySample sample = draw_verdict_sample(few, pair_, bench::QueryKind::collide, 900);
  std::map<long, std::size_t> counts;  // of poses near contact, by their gap in 0.01 % of the diagonal
  for (const Reference& reference : sample.references) {
    if (reference.nearness != Nearness::near || reference.known.key.kind == BucketKind::volume) continue;
    ++counts[std::lround(1e4 * reference.known.target / reference.known.diagonal)];
  }
  EXPECT_EQ(counts, (std::map<long, std::size_t>{{1, k_poses}, {10, k_poses}, {30, k_poses}}));
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
  if (machine_is_busy()) GTEST_SKIP() << "other work interrupts loops: queries would be late";
  const results::Choice found = undisturbed(1e-3);
  EXPECT_EQ(name(found.taken()), "warm warm_start=on");
  EXPECT_NE(study_->points()[1].left_out.find("over the deadline"), std::string::npos) << "without a warm start";
  sample_.motions = {};
  const results::Choice apart = undisturbed(1e-3);
  EXPECT_EQ(name(apart.taken()), "coarse steps=10") << "where poses are far apart";
}

TEST_F(RecommendInMotion, TakesNothingThatFailsOnTheWay) {
  if (machine_is_busy()) GTEST_SKIP() << "other work interrupts loops: queries would be late";
  WarmQuery::fails = true;
  const results::Choice found = undisturbed(1e-3);
  EXPECT_EQ(name(found.taken()), "coarse steps=10");
  const PrecisionPoint& point = study_->points()[0];
  EXPECT_TRUE(point.faulty());
  EXPECT_EQ(point.metric("failed")->value, static_cast<double>(point.errors.failed));
  EXPECT_GE(point.errors.failed, sample_.poses.size());
}

}  // namespace
}  // namespace sixdof::study
