#include <sixdof/scene/score.h>

#include <map>

#include <sixdof/scene/all_pairs.h>
#include <sixdof/scene/exact_scene.h>
#include "small_scenes.h"

// Planted faults: algorithms that are wrong in one respect are found out.

namespace sixdof::scene {
namespace {

/// Passes frames and answers on; a fault overrides either.
class Faulty : public SceneQuery {
 public:
  Faulty(const Scene& scene, Question question) : query_(make_exact_scene()->prepare(scene, question)) {}
  void update(std::span<const Moved> moved) override { query_->update(moved); }
  const SceneAnswer& answer() override { return query_->answer(); }

 protected:
  std::unique_ptr<SceneQuery> query_;
};

/// Drops one pair in ten thousand.
class DropsPairs final : public Faulty {
 public:
  using Faulty::Faulty;
  const SceneAnswer& answer() override {
    answer_ = query_->answer();
    std::erase_if(answer_.pairs, [this](const NearPair&) { return ++count_ % 10'000 == 0; });
    return answer_;
  }

 private:
  std::size_t count_ = 0;
  SceneAnswer answer_;
};

/// Learns of the motion of one body a frame late.
class StaleBox final : public Faulty {
 public:
  using Faulty::Faulty;
  void update(std::span<const Moved> moved) override {
    std::map<std::uint32_t, Pose> now = std::exchange(late_, {});
    for (const Moved& each : moved) {
      now.erase(each.body);
      (each.body == 1 ? late_ : now)[each.body] = each.X_WB;
    }
    std::vector<Moved> list;
    for (const auto& [body, pose] : now) list.push_back({body, pose});
    query_->update(list);
  }

 private:
  std::map<std::uint32_t, Pose> late_;
};

/// Takes the margin for each of the two bodies.
class TwiceTheMargin final : public SceneQuery {
 public:
  TwiceTheMargin(const Scene& scene, Question question) : scene_(scene) {
    scene_.margin *= 2.0;
    query_ = make_exact_scene()->prepare(scene_, question);
  }
  void update(std::span<const Moved> moved) override { query_->update(moved); }
  const SceneAnswer& answer() override { return query_->answer(); }

 private:
  Scene scene_;
  std::unique_ptr<SceneQuery> query_;
};

template <class Query>
std::unique_ptr<SceneAlgorithm> third_party() {
  return make_scene_algorithm<Query>({.name = "faulty", .answers = {Question::touching, Question::near}});
}

TEST(Score, FindsNothingWrongWithTheTruth) {
  const Scene scene = make_scene("pile", {.bodies = 100, .frames = 5});
  const SceneAnswers truth = replay(scene, *make_all_pairs(), Question::near);
  const Play play = scene::play(scene, *make_exact_scene(), Question::near, truth);
  EXPECT_FALSE(play.score.failed());
  EXPECT_TRUE(play.score.same_bits);
  EXPECT_EQ(play.score.true_pairs, truth.pairs());
  EXPECT_EQ(play.score.frames, 5u);
  EXPECT_EQ(play.score.largest_error, 0.0);
  EXPECT_EQ(play.score.hash, truth.hash);
  EXPECT_EQ(play.pairs_in_all, 5u * 100u * 99u / 2u);
  EXPECT_GT(play.bytes, 10'000u);
  EXPECT_GE(play.timing.max_us, play.timing.p99_us);
}

TEST(Score, FindsAPairInTenThousandThatIsDropped) {
  const Scene scene = make_scene("pile", {.bodies = 400, .frames = 40, .moving = 0.1});
  const SceneAnswers truth = replay(scene, *make_exact_scene(), Question::near);
  ASSERT_GT(truth.pairs(), 20'000u);
  const Play play = scene::play(scene, *third_party<DropsPairs>(), Question::near, truth);
  EXPECT_TRUE(play.score.failed());
  EXPECT_EQ(play.score.missed + play.score.grazing, truth.pairs() / 10'000);
  EXPECT_EQ(play.score.wrong, 0u);
  ASSERT_TRUE(play.score.first);
  EXPECT_TRUE(play.score.first->missed);
  EXPECT_LE(play.score.first->truth, scene.margin);
}

TEST(Score, FindsAStaleBox) {
  // Body 1 is one of 150; all move by a tenth of their size.
  const Scene scene = make_scene("cube", {.bodies = 150, .frames = 60, .density = 0.3});
  const SceneAnswers truth = replay(scene, *make_exact_scene(), Question::touching);
  const Play play = scene::play(scene, *third_party<StaleBox>(), Question::touching, truth);
  EXPECT_GT(play.score.missed, 0u);
  EXPECT_GT(play.score.wrong, 0u);
  EXPECT_FALSE(play.score.same_bits);
  const auto of_body_1 = [](const BodyPair& pair) { return pair.a == 1 || pair.b == 1; };
  EXPECT_TRUE(of_body_1(play.score.first->pair));
}

TEST(Score, FindsAMarginThatIsTakenTwice) {
  const Scene scene = make_scene("cube", {.bodies = 150, .frames = 5, .density = 0.1});
  const SceneAnswers truth = replay(scene, *make_exact_scene(), Question::near);
  const Play play = scene::play(scene, *third_party<TwiceTheMargin>(), Question::near, truth);
  EXPECT_EQ(play.score.missed, 0u);
  EXPECT_GT(play.score.wrong, 10u);
  ASSERT_TRUE(play.score.first);
  EXPECT_GT(play.score.first->truth, scene.margin);
  EXPECT_LE(play.score.first->truth, 2.0 * scene.margin);
}

TEST(Score, CountsGrazingPairsApart) {
  // Neighbours are apart by the margin less a millionth of their size.
  const double margin = 0.25;
  const Scene scene = row_of_spheres(6, 0.25 - 1e-6, 0.0, 1, margin);
  SceneAnswers truth = replay(scene, *make_all_pairs(), Question::near);
  SceneAnswers none = truth;
  none.frames[0].pairs.clear();
  set_hash(none);
  const std::size_t pairs = truth.pairs();
  const Score lenient = score(scene, Question::near, truth, none, false);
  const Score strict = score(scene, Question::near, truth, none, true);
  EXPECT_EQ(strict.missed, pairs);
  EXPECT_EQ(lenient.missed + lenient.grazing, pairs);
  EXPECT_EQ(score(scene, Question::near, none, truth, true).wrong, pairs);
}

TEST(Score, CountsBodiesInsideOthersApartForWhatLooksAtSurfaces) {
  Scene scene = row_of_spheres(2, -0.1, 0.0, 1, 0.0);
  scene.meshes.push_back(std::make_shared<const Mesh>(make_sphere({.radius = 0.2}, 80)));
  scene.bodies.push_back({50, 1, false, RecordedPose::of(Eigen::Matrix3d::Identity(), {0.05, 0.1, -0.2})});
  const SceneAnswers truth = replay(scene, *make_all_pairs(), Question::touching);
  SceneAnswers surfaces = truth;
  std::erase_if(surfaces.frames[0].pairs, [](const NearPair& near) { return near.pair == BodyPair{10, 50}; });
  ASSERT_EQ(surfaces.pairs() + 1, truth.pairs());
  set_hash(surfaces);
  const Score declared = score(scene, Question::touching, truth, surfaces, false, true);
  EXPECT_EQ(std::pair(declared.missed, declared.nested), std::pair(std::size_t{0}, std::size_t{1}));
  EXPECT_FALSE(declared.failed());
  const Score bodies = score(scene, Question::touching, truth, surfaces, false);
  EXPECT_EQ(std::pair(bodies.missed, bodies.nested), std::pair(std::size_t{1}, std::size_t{0}));
  // A pair whose surfaces meet is missed by anyone.
  SceneAnswers none = truth;
  none.frames[0].pairs.clear();
  EXPECT_EQ(score(scene, Question::touching, truth, none, true, true).missed, truth.pairs() - 1);
}

TEST(Score, AFrameAloneHasItsTime) {
  const Scene one = row_of_spheres(6, -0.1, 0.0, 1, 0.0);
  const SceneAnswers truth = replay(one, *make_all_pairs(), Question::touching);
  const Timing timing = scene::play(one, *make_exact_scene(), Question::touching, truth).timing;
  EXPECT_GT(timing.first_us, 0.0);
  EXPECT_GT(timing.processor_us, 0.0);
  EXPECT_EQ(timing.mean_us, timing.first_us);
  EXPECT_EQ(timing.p99_us, timing.first_us);
  EXPECT_EQ(timing.max_us, timing.first_us);
}

}  // namespace
}  // namespace sixdof::scene
