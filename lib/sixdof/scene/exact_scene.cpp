#include <sixdof/scene/exact_scene.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include <sixdof/base/parallel.h>
#include <sixdof/scene/bodies.h>
#include <sixdof/scene/kept_pairs.h>
#include <sixdof/scene/sweeps.h>

namespace sixdof::scene {
namespace {

using detail::KeptPair;
using detail::PairMemory;

/// A search looks as many frames' motion further than it must, if that is not more than a share of the smaller body's
/// radius: beyond, searching further costs more than asking again.
constexpr double k_frames_ahead = 8.0;
constexpr double k_largest_horizon = 0.3;
/// Fewer pairs are searched by one thread.
constexpr std::size_t k_worth_threads = 64;
/// Pairs that are searched with one limit when the closest pair is sought.
constexpr std::size_t k_batch = 32;
/// The broad phase's reach over the distance of the closest pair, when it must find all pairs anew.
constexpr double k_headroom = 1.5;
/// Known pairs per body beyond which a smaller reach is worth finding them anew.
constexpr std::size_t k_too_many = 8;

class ExactScene final : public SceneQuery {
 public:
  ExactScene(const Scene& scene, Question question, MeshUpdate mesh_update)
      : scene_(scene),
        question_(question),
        mesh_update_(question == Question::wrenches ? MeshUpdate::rebuild : mesh_update),
        margin_(question == Question::near ? scene.margin : 0.0),
        bodies_(scene),
        motions_(bodies_.size()),
        kept_(bodies_) {
    if (question == Question::wrenches) wrenches_.emplace(scene, bodies_);
    if (question == Question::impacts) sweeps_.emplace(scene, bodies_);
  }

  void deform(std::span<const Deformed> deformed) override {
    if (deformed.empty()) return;
    note_work();
    for (const Deformed& each : deformed) {
      const auto [motion, solid_changed] = bodies_.deform(each, mesh_update_);
      if (wrenches_) wrenches_->deform(scene_, bodies_, each);
      for (const std::uint32_t rank : bodies_.ranks_of(each.mesh)) {
        motions_.add(rank, motion, frame_ + 1);
        moved_.push_back(rank);
        if (solid_changed) forget(rank);
      }
    }
    known_ = false;
  }

  void update(std::span<const Moved> moved) override {
    ++frame_;
    if (sweeps_) {
      sweeps_->clear();
      known_ = false;
    }
    if (moved.empty()) return;
    for (const Moved& each : moved) {
      const std::uint32_t rank = bodies_.rank(each.body);
      if (sweeps_) sweeps_->add(bodies_, rank, each.X_WB);
      motions_.add(rank, bodies_.move(rank, each.X_WB), frame_);
      moved_.push_back(rank);
    }
    known_ = false;
  }

  const SceneAnswer& answer() override {
    if (std::exchange(known_, true)) return answer_;
    make_far_meshes_fresh();
    if (scene_.deforms()) {  // a body may have deformed and moved
      std::ranges::sort(moved_);
      const auto twice = std::ranges::unique(moved_);
      moved_.erase(twice.begin(), twice.end());
    }
    if (question_ == Question::closest) {
      find_closest();
    } else if (question_ == Question::impacts) {
      find_impacts();
    } else {
      find_within();
    }
    moved_.clear();
    return answer_;
  }

  SceneWork work() const override {
    SceneWork work = work_;
    for (NearQuery& query : queries_) work.triangles += query.counts().triangles;
    for (const std::uint32_t mesh : bodies_.deforming()) work.built += bodies_.deforming(mesh).built_triangles();
    return work;
  }

  std::size_t bytes() const override { return bodies_.bytes() + kept_.bytes() + (wrenches_ ? wrenches_->bytes() : 0); }

 private:
  /// Tells the meshes that deform what the queries of the frame before cost. It is not known which of them caused it.
  void note_work() {
    std::uint64_t nodes = 0;
    for (NearQuery& query : queries_) nodes += query.counts().nodes;
    const auto share = static_cast<double>(nodes - std::exchange(noted_nodes_, nodes)) /
                       static_cast<double>(bodies_.deforming().size());
    for (const std::uint32_t mesh : bodies_.deforming()) bodies_.deforming(mesh).note_work(share);
  }

  /// All that is known of a body's pairs no longer holds.
  void forget(std::uint32_t rank) {
    for (std::size_t k = 0; k < kept_.pairs().size(); ++k) {
      KeptPair& pair = kept_.pairs()[k];
      if (pair.a != rank && pair.b != rank) continue;
      pair.meets_at = KeptPair().meets_at;
      kept_.memory()[k] = PairMemory();
    }
  }

  /// Distances of bodies that are far apart have the bits of a tree that was built whole.
  void make_far_meshes_fresh() {
    if (question_ != Question::near && question_ != Question::closest) return;
    for (const std::uint32_t mesh : bodies_.deforming()) {
      for (const std::uint32_t rank : bodies_.ranks_of(mesh)) {
        if (is_far_from_another(rank)) bodies_.deforming(mesh).make_fresh();
      }
    }
  }

  bool is_far_from_another(std::uint32_t rank) const {
    for (std::uint32_t other = 0; other < bodies_.size(); ++other) {
      const auto [a, b] = std::minmax(rank, other);
      if (other == rank || !bodies_.matters(a, b)) continue;
      if (NearQuery::are_far(bodies_.mesh(a), bodies_.mesh(b), bodies_.relative(a, b))) return true;
    }
    return false;
  }

  /// How much further than needed a pair is searched (length).
  double horizon(const KeptPair& pair) const {
    const double ahead = k_frames_ahead * (motions_.last(pair.a) + motions_.last(pair.b));
    const double most = k_largest_horizon * std::min(bodies_.radius(pair.a), bodies_.radius(pair.b));
    return ahead <= most ? ahead : 0.0;
  }

  /// Searches one pair; it may be within `reach`. @param further also find out whether it is further than that by as
  /// much
  void ask(std::size_t k, double reach, double further) {
    KeptPair& pair = kept_.pairs()[k];
    PairMemory& memory = kept_.memory()[k];
    NearQuery& query = queries_.local();
    const PreparedMesh &a = bodies_.mesh(pair.a), &b = bodies_.mesh(pair.b);
    const Pose X_AB = bodies_.relative(pair.a, pair.b);
    const double slack = bodies_.rounding(pair.a, pair.b);
    const bool did_meet = std::exchange(memory.within, false) && !std::exchange(memory.nested, false);
    const double limit = reach + further;
    memory.asked = frame_;
    if (reach == 0.0 && (further == 0.0 || did_meet)) {
      memory.within = query.surfaces_meet(a, b, X_AB, memory.hint);
      memory.distance = 0.0;
      motions_.note(pair, -slack);
    } else if (const auto distance = query.distance(a, b, X_AB, limit, memory.hint)) {
      memory.within = *distance <= reach;
      memory.distance = *distance;
      motions_.note(pair, *distance - slack);
    } else {
      motions_.note(pair, limit - slack);
    }
    if (memory.within || !is_of_bodies(question_)) return;
    memory.nested = query.is_nested(a, b, X_AB);
    memory.within = memory.nested;
    memory.distance = 0.0;
  }

  /// Whether boxes and spheres show that the pair is further apart than `reach`; then notes it.
  bool is_certainly_apart(KeptPair& pair, double reach) {
    const double lower = bodies_.lower_bound(pair.a, pair.b);
    if (!(lower > reach)) return false;
    motions_.note(pair, lower);
    return true;
  }

  /// Whether a pair's answer may be another one than before.
  bool must_ask(std::size_t k, double reach) {
    KeptPair& pair = kept_.pairs()[k];
    PairMemory& memory = kept_.memory()[k];
    if (memory.asked > 0 && !motions_.moved_since(pair, memory.asked)) return false;
    if (!is_certainly_apart(pair, reach)) return true;
    memory.within = false;
    memory.nested = false;
    memory.asked = frame_;
    return false;
  }

  template <class Body>
  void for_each(std::span<const std::size_t> places, const Body& body) {
    if (places.size() < k_worth_threads) {
      for (const std::size_t k : places) body(k);
    } else {
      parallel::for_each(places.size(), [&](std::size_t i) { body(places[i]); });
    }
  }

  /// The pairs within the margin, as ranks with distances.
  void find_within() {
    kept_.update(bodies_, motions_, moved_, margin_);
    const std::span<KeptPair> pairs = kept_.pairs();
    active_.clear();
    asked_.clear();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const bool is_put_off = motions_.distance_left(pairs[k]) > margin_;
      if (is_put_off && !kept_.memory()[k].nested) continue;
      active_.push_back(k);
      if (!is_put_off && must_ask(k, margin_)) asked_.push_back(k);
    }
    for_each(asked_, [&](std::size_t k) { ask(k, margin_, horizon(kept_.pairs()[k])); });
    count(pairs.size(), asked_.size());
    near_.clear();
    for (const std::size_t k : active_) {
      if (kept_.memory()[k].within) near_.push_back({{pairs[k].a, pairs[k].b}, kept_.memory()[k].distance});
    }
    publish();
  }

  /// The pairs that come together in this frame: of those whose boxes are as close as the longest motions, the ones of
  /// which a body moves and whose bounds on the distance do not exceed their own.
  void find_impacts() {
    near_.clear();
    if (const double reach = sweeps_->largest_reach(); reach > 0.0) {
      kept_.update(bodies_, motions_, moved_, reach, k_headroom);
      const std::span<KeptPair> pairs = kept_.pairs();
      asked_.clear();
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        KeptPair& pair = pairs[k];
        if (!sweeps_->moves(pair.a) && !sweeps_->moves(pair.b)) continue;
        const double most = sweeps_->reach(pair.a, pair.b);
        if (motions_.distance_left(pair) > most || is_certainly_apart(pair, most)) continue;
        asked_.push_back(k);
      }
      times_.assign(pairs.size(), k_no_contact);
      for_each(asked_, [&](std::size_t k) {
        const auto found = sweeps_->first_contact(bodies_, queries_.local(), pairs[k].a, pairs[k].b);
        times_[k] = found.undecided ? k_undecided : found.t.value_or(k_no_contact);
      });
      count(pairs.size(), asked_.size());
      for (const std::size_t k : asked_) {
        work_.undecided += times_[k] == k_undecided ? 1 : 0;
        if (times_[k] >= 0.0) near_.push_back({{pairs[k].a, pairs[k].b}, times_[k]});
      }
    }
    publish();
  }

  /// The closest pair. The pairs that are known already make a good guess better; only if that is further away than the
  /// reach for which pairs are known, more are found.
  void find_closest() {
    NearPair best = first_guess();
    const bool too_many = kept_.pairs().size() > k_too_many * bodies_.size();
    double reach = std::max(0.0, kept_.reach());
    if (too_many) reach = std::min(reach, best.distance);
    for (;;) {
      kept_.update(bodies_, motions_, moved_, reach, k_headroom);
      improve(best);
      if (best.distance <= kept_.reach()) break;
      reach = best.distance;
    }
    near_.clear();
    if (has_pair_) near_.push_back(best);
    publish();
  }

  /// Searches all known pairs whose lower bound does not exceed the smallest distance so far, in batches, the smallest
  /// bound first.
  void improve(NearPair& best) {
    const std::span<KeptPair> pairs = kept_.pairs();
    order_.clear();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      if (best.distance == 0.0 && BodyPair{pairs[k].a, pairs[k].b} >= best.pair) break;  // pairs are sorted
      if (motions_.distance_left(pairs[k]) > best.distance || is_certainly_apart(pairs[k], best.distance)) continue;
      order_.emplace_back(motions_.distance_left(pairs[k]), k);
    }
    std::ranges::sort(order_);
    std::size_t asked = 0;
    for (std::size_t begin = 0; begin < order_.size();) {
      asked_.clear();
      for (; begin < order_.size() && asked_.size() < k_batch; ++begin) {
        const auto [lower, k] = order_[begin];
        const BodyPair here{pairs[k].a, pairs[k].b};
        if (lower > best.distance || here == best.pair || (best.distance == 0.0 && here > best.pair)) continue;
        asked_.push_back(k);
      }
      asked += asked_.size();
      const double limit = best.distance;
      for_each(asked_, [&](std::size_t k) { ask(k, limit, 0.0); });
      for (const std::size_t k : asked_) {
        const PairMemory& memory = kept_.memory()[k];
        if (!memory.within) continue;
        const NearPair found{{pairs[k].a, pairs[k].b}, memory.distance};
        if (std::pair(found.distance, found.pair) < std::pair(best.distance, best.pair)) best = found;
      }
    }
    count(pairs.size(), asked);
  }

  /// A pair with its distance at the poses of this frame: the last closest one; at first, one that is found at once.
  NearPair first_guess() {
    BodyPair pair;
    if (near_.size() == 1) {
      pair = near_.front().pair;
    } else {
      const auto close = close_pair();
      has_pair_ = close.has_value();
      if (!close) return {{0, 0}, 0.0};
      pair = *close;
    }
    NearHint none;
    const auto distance = queries_.local().distance(bodies_.mesh(pair.a), bodies_.mesh(pair.b),
                                                    bodies_.relative(pair.a, pair.b), NearQuery::k_no_limit, none);
    return {pair, distance.value_or(NearQuery::k_no_limit)};
  }

  /// Some pair that matters whose boxes are close, if any pair matters.
  std::optional<BodyPair> close_pair() const {
    std::optional<BodyPair> best;
    double least = NearQuery::k_no_limit;
    const auto n = static_cast<std::uint32_t>(bodies_.size());
    std::vector<std::uint32_t> order(n);
    for (std::uint32_t i = 0; i < n; ++i) order[i] = i;
    for (int axis = 0; axis < 3; ++axis) {
      std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return bodies_.center(i)[axis]; });
      for (std::uint32_t k = 1; k < n; ++k) {
        const BodyPair pair = BodyPair::of(order[k - 1], order[k]);
        if (!bodies_.matters(pair.a, pair.b)) continue;
        const double gap = bodies_.box(pair.a).gap(bodies_.box(pair.b));
        if (best && !(gap < least)) continue;
        least = gap;
        best = pair;
      }
    }
    for (std::uint32_t i = 0; i < n && !best; ++i) {
      for (std::uint32_t j = i + 1; j < n && !best; ++j) {
        if (bodies_.matters(i, j)) best = BodyPair{i, j};
      }
    }
    return best;
  }

  void count(std::size_t candidates, std::size_t asked) {
    work_.candidates += candidates;
    work_.narrow += asked;
    work_.put_off += candidates - asked;
  }

  /// Makes the answer of near_.
  void publish() {
    answer_.pairs.clear();
    for (const NearPair& near : near_) {
      answer_.pairs.push_back({{bodies_.id(near.pair.a), bodies_.id(near.pair.b)}, near.distance});
    }
    if (!wrenches_) return;
    std::vector<BodyPair> ranks;
    for (const NearPair& near : near_) ranks.push_back(near.pair);
    answer_.wrenches = wrenches_->sum(bodies_, ranks);
  }

  const Scene& scene_;
  Question question_;
  MeshUpdate mesh_update_;
  double margin_;
  detail::Bodies bodies_;
  detail::Motions motions_;
  detail::KeptPairs kept_;
  std::optional<detail::Wrenches> wrenches_;
  std::optional<detail::Sweeps> sweeps_;
  static constexpr double k_no_contact = -1.0, k_undecided = -2.0;
  std::vector<double> times_;  // of the first contact of a pair, or one of these
  mutable parallel::PerThread<NearQuery> queries_;
  std::uint64_t noted_nodes_ = 0;
  std::uint32_t frame_ = 1;
  std::vector<std::uint32_t> moved_;
  std::vector<std::size_t> active_, asked_;            // places in kept_.pairs()
  std::vector<std::pair<double, std::size_t>> order_;  // lower bounds and places
  std::vector<NearPair> near_;                         // by rank
  bool has_pair_ = false;
  bool known_ = false;
  SceneAnswer answer_;
  SceneWork work_;
};

}  // namespace

std::unique_ptr<SceneAlgorithm> make_exact_scene(MeshUpdate update) {
  SceneTraits traits{
      .name = "exact",
      .version = SIXDOF_VERSION,
      .summary = "kept boxes, pairs put off by bounds on their motion, the distance oracle up to a limit",
      .answers = {std::begin(k_questions), std::end(k_questions)},
      .own = true,
      .deforms = true};
  if (update != MeshUpdate::rule) {
    const bool refits = update == MeshUpdate::refit;
    traits.name += refits ? "-refit" : "-rebuild";
    traits.summary = refits ? "exact, whose trees are refitted when meshes deform, and never built anew"
                            : "exact, whose trees are built anew when meshes deform";
    traits.rigid = false;
  }
  return make_scene_algorithm<ExactScene>(std::move(traits), update);
}

}  // namespace sixdof::scene
