#include <sixdof/scene/score.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/query/timed_loop.h>
#include <sixdof/scene/bodies.h>

namespace sixdof::scene {
namespace {

using Eigen::Vector3d;

/// Decides which pairs graze, at the poses of one frame after the other.
class Judge {
 public:
  Judge(const Scene& scene, Question question) : scene_(scene), question_(question), bodies_(scene) {}

  void update(std::size_t frame) {
    for (const Deformed& each : shapes_of(scene_, frame)) shapes_[each.mesh] = each.vertices;
    for (const Moved& each : moves_of(scene_.frames[frame])) bodies_.move(bodies_.rank(each.body), each.X_WB);
  }

  double distance(const BodyPair& pair) { return distance(pair, Vector3d::Zero()); }

  bool grazes(const BodyPair& pair) {
    const double here = distance(pair);
    const double size = 2.0 * (bodies_.radius(bodies_.rank_of_id(pair.a)) + bodies_.radius(bodies_.rank_of_id(pair.b)));
    const double shift = Score::k_grazing * size;
    const double limit = question_ == Question::near ? scene_.margin : 0.0;
    if (here > 0.0) return std::abs(here - limit) <= shift;
    if (limit > 0.0) return limit <= shift;
    for (int k = 0; k < 6; ++k) {
      const Vector3d by = (k % 2 == 0 ? shift : -shift) * Vector3d::Unit(k / 2);
      if (distance(pair, by) > 0.0) return true;
    }
    return false;
  }

 private:
  double distance(const BodyPair& pair, const Vector3d& shift) {
    // Most frames need no judge, so meshes are deformed for those that do.
    for (const auto& [mesh, vertices] : shapes_) bodies_.deform({mesh, vertices}, MeshUpdate::rebuild);
    shapes_.clear();
    const std::uint32_t a = bodies_.rank_of_id(pair.a), b = bodies_.rank_of_id(pair.b);
    Pose X_WB = bodies_.pose(b);
    X_WB.t += shift;
    NearHint none;
    return query_
        .distance(bodies_.mesh(a), bodies_.mesh(b), bodies_.pose(a).inverse() * X_WB, NearQuery::k_no_limit, none)
        .value_or(NearQuery::k_no_limit);
  }

  const Scene& scene_;
  Question question_;
  detail::Bodies bodies_;
  std::map<std::uint32_t, std::span<const Vector3d>> shapes_;  // of meshes that have deformed since bodies_ knows them
  NearQuery query_;
};

class Scorer {
 public:
  Scorer(const Scene& scene, Question question, bool exactly, bool surfaces_only)
      : judge_(scene, question), question_(question), exactly_(exactly), surfaces_only_(surfaces_only) {}

  Score run(const Scene& scene, const SceneAnswers& truth, const SceneAnswers& answers) {
    if (truth.frames.size() != scene.frames.size() || answers.frames.size() != scene.frames.size()) {
      throw Error("answers of another number of frames");
    }
    for (std::size_t f = 0; f < scene.frames.size(); ++f) {
      frame_ = f;
      judge_.update(f);
      score_.true_pairs += truth.frames[f].pairs.size();
      question_ == Question::closest ? compare_closest(truth.frames[f], answers.frames[f])
                                     : compare(truth.frames[f].pairs, answers.frames[f].pairs);
    }
    score_.frames = scene.frames.size();
    score_.same_bits = truth.hash == answers.hash;
    score_.hash = answers.hash;
    return score_;
  }

 private:
  void compare(const std::vector<NearPair>& truth, const std::vector<NearPair>& found) {
    auto t = truth.begin();
    auto f = found.begin();
    while (t != truth.end() || f != found.end()) {
      if (f == found.end() || (t != truth.end() && t->pair < f->pair)) {
        add(t->pair, true);
        ++t;
      } else if (t == truth.end() || f->pair < t->pair) {
        add(f->pair, false);
        ++f;
      } else {
        score_.largest_error = std::max(score_.largest_error, std::abs(t->distance - f->distance));
        ++t;
        ++f;
      }
    }
  }

  /// Of equally close pairs any will do.
  void compare_closest(const SceneAnswer& truth, const SceneAnswer& found) {
    if (truth.pairs.empty() && found.pairs.empty()) return;
    if (truth.pairs.empty()) return add(found.pairs.front().pair, false);
    if (found.pairs.empty()) return add(truth.pairs.front().pair, true);
    const NearPair& t = truth.pairs.front();
    const NearPair& f = found.pairs.front();
    score_.largest_error = std::max(score_.largest_error, std::abs(t.distance - f.distance));
    if (t.pair == f.pair) return;
    // Another pair is as good if it is as close.
    if (t.distance < judge_.distance(f.pair)) add(t.pair, true);
  }

  void add(const BodyPair& pair, bool missed) {
    if (!exactly_ && judge_.grazes(pair)) {
      ++score_.grazing;
      return;
    }
    if (missed && surfaces_only_ && is_of_bodies(question_) && judge_.distance(pair) > 0.0) {
      ++score_.nested;
      return;
    }
    if (!score_.first || (missed && !score_.first->missed))
      score_.first = {frame_, pair, judge_.distance(pair), missed};
    ++(missed ? score_.missed : score_.wrong);
  }

  Judge judge_;
  Question question_;
  bool exactly_, surfaces_only_;
  std::size_t frame_ = 0;
  Score score_;
};

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void check(const SceneAnswer& answer, const std::string& name) {
  if (std::ranges::adjacent_find(answer.pairs, std::greater_equal<>(), &NearPair::pair) != answer.pairs.end()) {
    throw Error(fmt::format("{}: the pairs of an answer are not sorted, or one comes twice", name));
  }
  for (const NearPair& near : answer.pairs) {
    if (!(near.distance >= 0.0) || !std::isfinite(near.distance)) {
      throw Error(fmt::format("{}: the distance of {} and {} is {}", name, near.pair.a, near.pair.b, near.distance));
    }
  }
}

/// Processor time (s).
struct Processor {
  double update = 0.0, answer = 0.0;
};

/// @param frames wall times (us) @param first, others of the first frame and of all others
Timing summary(std::vector<double> frames, const Processor& first, Processor others) {
  Timing timing;
  timing.first_us = frames.front();
  if (frames.size() == 1) {
    others = first;
  } else {
    frames.erase(frames.begin());
  }
  for (const double us : frames) timing.mean_us += us / static_cast<double>(frames.size());
  timing.update_us = 1e6 * others.update / static_cast<double>(frames.size());
  timing.answer_us = 1e6 * others.answer / static_cast<double>(frames.size());
  timing.processor_us = timing.update_us + timing.answer_us;
  std::ranges::sort(frames);
  timing.p99_us = frames[(frames.size() * 99 + 99) / 100 - 1];
  timing.max_us = frames.back();
  return timing;
}

}  // namespace

Score score(const Scene& scene, Question question, const SceneAnswers& truth, const SceneAnswers& answers, bool exactly,
            bool surfaces_only) {
  return Scorer(scene, question, exactly, surfaces_only).run(scene, truth, answers);
}

double Play::false_per_true() const {
  if (score.true_pairs == 0) return static_cast<double>(work.narrow);
  return std::max(0.0, static_cast<double>(work.narrow) - static_cast<double>(score.true_pairs)) /
         static_cast<double>(score.true_pairs);
}

Play play(const Scene& scene, const SceneAlgorithm& algorithm, Question question, const SceneAnswers& truth,
          const std::function<bool()>& cancelled) {
  Play result;
  const double before = wall_seconds();
  const auto query = algorithm.prepare(scene, question);
  const double prepared = wall_seconds();
  std::vector<double> times;
  Processor first, others;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    if (cancelled && cancelled()) throw Interrupted("interrupted");
    const std::vector<Moved> moved = moves_of(scene.frames[f]);
    const std::vector<Deformed> deformed = shapes_of(scene, f);
    Processor& used = f == 0 ? first : others;
    const double begin = processor_ns();
    const double start = wall_seconds();
    query->deform(deformed);
    query->update(moved);
    const double updated = processor_ns();
    const SceneAnswer& answer = query->answer();
    times.push_back(1e6 * (wall_seconds() - start));
    used.update += 1e-9 * (updated - begin);
    used.answer += 1e-9 * (processor_ns() - updated);
    check(answer, algorithm.traits().name);
    result.answers.frames.push_back(answer);
  }
  result.timing = summary(std::move(times), first, others);
  result.timing.prepare_s = prepared - before;
  result.work = query->work();
  result.bytes = query->bytes();
  result.pairs_in_all = PairFilter(scene).pairs() * scene.frames.size();
  set_hash(result.answers);
  result.score =
      score(scene, question, truth, result.answers, algorithm.traits().own, algorithm.traits().surfaces_only);
  return result;
}

}  // namespace sixdof::scene
