#include <sixdof/scene/all_pairs.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>

#include <sixdof/base/parallel.h>
#include <sixdof/scene/bodies.h>
#include <sixdof/scene/sweeps.h>

namespace sixdof::scene {
namespace {

/// Boxes of all bodies, one array per side, so that one body is compared with many at once. In single precision,
/// rounded outwards.
class BoxArrays {
 public:
  explicit BoxArrays(const detail::Bodies& bodies) {
    for (int k = 0; k < 3; ++k) {
      for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        lower_[k].push_back(std::nextafter(static_cast<float>(bodies.box(i).lower[k]), -k_infinity));
        upper_[k].push_back(std::nextafter(static_cast<float>(bodies.box(i).upper[k]), k_infinity));
      }
    }
  }

  /// Calls found(j) for every j > i whose box is not certainly further than `reach` from that of i.
  template <class Found>
  void for_each_close(std::uint32_t i, float reach, const Found& found) const {
    float low[3], high[3];
    for (int k = 0; k < 3; ++k) {
      low[k] = std::nextafter(lower_[k][i] - reach, -k_infinity);
      high[k] = std::nextafter(upper_[k][i] + reach, k_infinity);
    }
    const std::size_t n = lower_[0].size();
    for (std::size_t begin = i + 1; begin < n; begin += k_block) {
      const std::size_t end = std::min(n, begin + k_block);
      unsigned any = 0;
      for (std::size_t j = begin; j < end; ++j) any |= close(low, high, j);
      for (std::size_t j = begin; any != 0 && j < end; ++j) {
        if (close(low, high, j) != 0) found(static_cast<std::uint32_t>(j));
      }
    }
  }

 private:
  static constexpr float k_infinity = std::numeric_limits<float>::infinity();
  static constexpr std::size_t k_block = 64;
  unsigned close(const float* low, const float* high, std::size_t j) const {
    unsigned all = 1;
    for (int k = 0; k < 3; ++k) {
      all &= static_cast<unsigned>(lower_[k][j] <= high[k]) & static_cast<unsigned>(upper_[k][j] >= low[k]);
    }
    return all;
  }
  std::vector<float> lower_[3], upper_[3];
};

class AllPairs final : public SceneQuery {
 public:
  AllPairs(const Scene& scene, Question question)
      : scene_(scene), question_(question), margin_(scene.margin), bodies_(scene) {
    if (question == Question::wrenches) wrenches_.emplace(scene, bodies_);
    if (question == Question::impacts) sweeps_.emplace(scene, bodies_);
  }

  void deform(std::span<const Deformed> deformed) override {
    for (const Deformed& each : deformed) {
      bodies_.deform(each, MeshUpdate::rebuild);
      if (wrenches_) wrenches_->deform(scene_, bodies_, each);
      work_.built += scene_.meshes[each.mesh]->triangles().size();
    }
  }

  void update(std::span<const Moved> moved) override {
    if (sweeps_) sweeps_->clear();
    for (const Moved& each : moved) {
      const std::uint32_t rank = bodies_.rank(each.body);
      if (sweeps_) sweeps_->add(bodies_, rank, each.X_WB);
      bodies_.move(rank, each.X_WB);
    }
    known_ = false;
  }

  const SceneAnswer& answer() override {
    if (!std::exchange(known_, true)) find();
    return answer_;
  }

  SceneWork work() const override { return work_; }
  std::size_t bytes() const override { return bodies_.bytes() + (wrenches_ ? wrenches_->bytes() : 0); }

 private:
  /// Of some bodies with those after them.
  struct Part {
    std::vector<NearPair> pairs;
    std::uint64_t candidates = 0, triangles = 0, undecided = 0;
  };

  /// Calls visit(part, query, i) for every rank, by several threads; pairs are sorted by rank.
  template <class Visit>
  std::vector<NearPair> find_pairs(std::size_t grain, const Visit& visit) {
    Part all = parallel::reduce<Part>(
        bodies_.size(), grain,
        [&](std::size_t begin, std::size_t end) {
          Part part;
          NearQuery query;
          for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) visit(part, query, i);
          part.triangles = query.counts().triangles;
          return part;
        },
        [](Part sum, const Part& part) {
          sum.pairs.insert(sum.pairs.end(), part.pairs.begin(), part.pairs.end());
          sum.candidates += part.candidates;
          sum.triangles += part.triangles;
          sum.undecided += part.undecided;
          return sum;
        });
    work_.candidates += all.candidates;
    work_.narrow += all.candidates;
    work_.triangles += all.triangles;
    work_.undecided += all.undecided;
    return std::move(all.pairs);
  }

  /// The pairs that are no further apart than `reach`, with their distances, sorted by rank; and those that are nested,
  /// if the question is of bodies.
  std::vector<NearPair> measure(double reach) {
    const BoxArrays boxes(bodies_);
    const auto narrow = static_cast<float>(reach * (1.0 + 1e-6));
    constexpr std::size_t k_grain = 16;
    return find_pairs(k_grain, [&](Part& part, NearQuery& query, std::uint32_t i) {
      boxes.for_each_close(i, narrow, [&](std::uint32_t j) {
        if (!bodies_.matters(i, j)) return;
        ++part.candidates;
        NearHint none;
        const Pose X_AB = bodies_.relative(i, j);
        const auto distance = query.distance(bodies_.mesh(i), bodies_.mesh(j), X_AB, NearQuery::k_no_limit, none);
        if (distance && *distance <= reach) {
          part.pairs.push_back({{i, j}, *distance});
        } else if (is_of_bodies(question_) && query.is_nested(bodies_.mesh(i), bodies_.mesh(j), X_AB)) {
          part.pairs.push_back({{i, j}, 0.0});
        }
      });
    });
  }

  void find() {
    std::vector<NearPair> pairs;
    switch (question_) {
      case Question::touching:
      case Question::wrenches:
        pairs = measure(0.0);
        break;
      case Question::near:
        pairs = measure(margin_);
        break;
      case Question::impacts:
        pairs = find_impacts();
        break;
      case Question::closest:
        pairs = measure(closest_centers());
        // The first of the smallest: pairs are sorted.
        if (!pairs.empty()) pairs = {*std::ranges::min_element(pairs, {}, &NearPair::distance)};
        break;
    }
    answer_ = {};
    if (wrenches_) {
      std::vector<BodyPair> ranks;
      for (const NearPair& near : pairs) ranks.push_back(near.pair);
      answer_.wrenches = wrenches_->sum(bodies_, ranks);
    }
    for (NearPair& near : pairs) near.pair = {bodies_.id(near.pair.a), bodies_.id(near.pair.b)};
    answer_.pairs = std::move(pairs);
  }

  /// Every pair of which a body moves, but for those that cannot have come together.
  std::vector<NearPair> find_impacts() {
    return find_pairs(1, [&](Part& part, NearQuery& query, std::uint32_t i) {
      for (std::uint32_t j = i + 1; j < bodies_.size(); ++j) {
        if (!(sweeps_->moves(i) || sweeps_->moves(j)) || !bodies_.matters(i, j)) continue;
        if (bodies_.box(i).gap(bodies_.box(j)) > sweeps_->reach(i, j)) continue;
        ++part.candidates;
        const auto found = sweeps_->first_contact(bodies_, query, i, j);
        part.undecided += found.undecided ? 1 : 0;
        if (found.t) part.pairs.push_back({{i, j}, *found.t});
      }
    });
  }

  /// An upper bound on the distance of the closest pair: that of the closest vertices, one of each body.
  double closest_centers() const {
    std::vector<Eigen::Vector3d> points;
    for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
      points.push_back(bodies_.pose(i) * bodies_.mesh(i).tree().corners().front()[0]);
    }
    const double squared = parallel::reduce<double>(
        points.size(), 16,
        [&](std::size_t begin, std::size_t end) {
          double least = std::numeric_limits<double>::infinity();
          for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t j = i + 1; j < points.size(); ++j) {
              const double d = (points[i] - points[j]).squaredNorm();
              if (d < least && bodies_.matters(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j))) least = d;
            }
          }
          return least;
        },
        [](double x, double y) { return std::min(x, y); });
    return std::sqrt(squared) * (1.0 + 1e-9);
  }

  const Scene& scene_;
  Question question_;
  double margin_;
  detail::Bodies bodies_;
  std::optional<detail::Wrenches> wrenches_;
  std::optional<detail::Sweeps> sweeps_;
  SceneAnswer answer_;
  SceneWork work_;
  bool known_ = false;
};

}  // namespace

std::unique_ptr<SceneAlgorithm> make_all_pairs() {
  return make_scene_algorithm<AllPairs>({.name = "all-pairs",
                                         .version = SIXDOF_VERSION,
                                         .summary = "every pair in every frame by the distance oracle: the truth",
                                         .answers = {std::begin(k_questions), std::end(k_questions)},
                                         .own = true,
                                         .by_default = false,
                                         .deforms = true});
}

}  // namespace sixdof::scene
