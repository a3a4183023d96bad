#pragma once

#include <algorithm>
#include <utility>

#include <sixdof/scene/scene_algorithm.h>

namespace sixdof::scene {

/// A scene in another library, whose bodies have their indices into Scene::bodies.
class LibraryScene : public SceneQuery {
 public:
  explicit LibraryScene(const Scene& scene) : scene_(scene), filter_(scene) {}

  void deform(std::span<const Deformed> deformed) final {
    if (deformed.empty()) return;
    known_ = false;
    reshape(deformed);
  }

  void update(std::span<const Moved> moved) final {
    if (moved.empty()) return;
    known_ = false;
    move(moved);
  }

  const SceneAnswer& answer() final {
    if (std::exchange(known_, true)) return answer_;
    answer_.pairs.clear();
    find();
    std::ranges::sort(answer_.pairs);
    // Some broad phases name a pair twice.
    const auto twice = std::ranges::unique(answer_.pairs, {}, &NearPair::pair);
    answer_.pairs.erase(twice.begin(), twice.end());
    return answer_;
  }

  SceneWork work() const final { return work_; }

 protected:
  virtual void move(std::span<const Moved> moved) = 0;
  /// Of scenes in which a mesh deforms, if SceneTraits::deforms says so.
  virtual void reshape(std::span<const Deformed> deformed) { SceneQuery::deform(deformed); }
  /// Calls take() for the pairs of the answer.
  virtual void find() = 0;

  /// Counts a candidate. @return whether the narrow phase is asked
  bool is_asked(std::uint32_t i, std::uint32_t j) {
    ++work_.candidates;
    const bool asked = filter_.matters(i, j);
    if (asked) ++work_.narrow;
    return asked;
  }

  void take(std::uint32_t i, std::uint32_t j, double distance = 0.0) {
    answer_.pairs.push_back({BodyPair::of(scene_.bodies[i].id, scene_.bodies[j].id), distance});
  }
  void forget_pairs() { answer_.pairs.clear(); }

  const Scene& scene_;

 private:
  const PairFilter filter_;
  bool known_ = false;
  SceneAnswer answer_;
  SceneWork work_;
};

}  // namespace sixdof::scene
