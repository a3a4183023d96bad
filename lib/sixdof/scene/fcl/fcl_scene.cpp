#include <sixdof/scene/fcl/fcl_scene.h>

#include <fcl/config.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/broadphase/broadphase_interval_tree.h>
#include <fcl/broadphase/broadphase_spatialhash.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>

#include <sixdof/algorithm/fcl/fcl_mesh.h>
#include <sixdof/scene/library_scene.h>

namespace sixdof::scene {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;
using Object = fcl::CollisionObjectd;
using Manager = fcl::BroadPhaseCollisionManagerd;
/// How one of FCL's managers is made and kept up to date.
struct ManagerKind {
  /// Makes an empty manager for these bodies.
  std::function<std::unique_ptr<Manager>(std::vector<Object*>&)> make;
  /// Whether FCL may be told which bodies moved. Else every update looks at all.
  bool updates_some = true;
};

class FclScene final : public LibraryScene {
 public:
  FclScene(const Scene& scene, Question question, const ManagerKind& kind)
      : LibraryScene(scene), question_(question), updates_some_(kind.updates_some) {
    std::vector<std::shared_ptr<Model>> models;
    for (const auto& mesh : scene.meshes) {
      models.push_back(build_fcl_model<fcl::OBBRSSd>(*mesh));
      models.back()->computeLocalAABB();
    }
    std::vector<Object*> moving, fixed;
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      auto& object = *objects_.emplace_back(std::make_unique<Object>(models[body.mesh], to_fcl(body.pose.pose())));
      object.computeAABB();
      object.setUserData(reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
      (body.fixed ? fixed : moving).push_back(&object);
    }
    if (!moving.empty()) moving_ = registered(kind, moving);
    if (!fixed.empty()) fixed_ = registered(kind, fixed);
  }

  void move(std::span<const Moved> moved) override {
    changed_.clear();
    for (const Moved& each : moved) {
      Object& object = *objects_[each.body];
      object.setTransform(to_fcl(each.X_WB));
      object.computeAABB();
      changed_.push_back(&object);
    }
    if (!updates_some_ || changed_.size() == moving_->size()) {
      moving_->update();
    } else {
      moving_->update(changed_);
    }
  }

  void find() override {
    limit_ = question_ == Question::near ? scene_.margin : std::numeric_limits<double>::max();
    if (moving_ && question_ == Question::touching) {
      moving_->collide(this, &on_pair);
      if (fixed_) moving_->collide(fixed_.get(), this, &on_pair);
    } else if (moving_) {
      moving_->distance(this, &on_distance);
      if (fixed_) moving_->distance(fixed_.get(), this, &on_distance);
    }
  }

 private:
  static std::unique_ptr<Manager> registered(const ManagerKind& kind, std::vector<Object*>& objects) {
    std::unique_ptr<Manager> manager = kind.make(objects);
    manager->registerObjects(objects);
    manager->setup();
    return manager;
  }

  static std::uint32_t index_of(const Object* object) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(object->getUserData()));
  }

  /// FCL's callback: true ends the query.
  static bool on_pair(Object* a, Object* b, void* self) {
    auto& scene = *static_cast<FclScene*>(self);
    const std::uint32_t i = index_of(a), j = index_of(b);
    if (!scene.is_asked(i, j)) return false;
    fcl::CollisionResultd result;
    fcl::collide(a, b, fcl::CollisionRequestd(1, false), result);
    if (result.isCollision()) scene.take(i, j);
    return false;
  }

  static bool on_distance(Object* a, Object* b, void* self, double& least) {
    auto& scene = *static_cast<FclScene*>(self);
    const std::uint32_t i = index_of(a), j = index_of(b);
    if (scene.is_asked(i, j)) {
      fcl::DistanceResultd result;
      fcl::distance(a, b, fcl::DistanceRequestd(false), result);
      scene.take_within_limit(i, j, std::max(result.min_distance, 0.0));
    }
    least = scene.limit_;
    return scene.question_ == Question::closest && scene.limit_ == 0.0;
  }

  void take_within_limit(std::uint32_t i, std::uint32_t j, double distance) {
    if (distance > limit_) return;
    if (question_ == Question::closest) {
      forget_pairs();
      limit_ = distance;
    }
    take(i, j, distance);
  }

  const Question question_;
  const bool updates_some_;
  std::vector<std::unique_ptr<Object>> objects_;
  std::unique_ptr<Manager> moving_, fixed_;
  std::vector<Object*> changed_;
  double limit_ = 0.0;
};

template <class T>
std::unique_ptr<Manager> make(std::vector<Object*>& /*objects*/) {
  return std::make_unique<T>();
}

std::unique_ptr<Manager> make_hash(std::vector<Object*>& objects) {
  using Table = fcl::detail::SparseHashTable<fcl::AABBd, Object*, fcl::detail::SpatialHashd>;
  using Hashing = fcl::SpatialHashingCollisionManager<double, Table>;
  constexpr double k_cells = 20.0;
  fcl::Vector3d lower, upper;
  Hashing::computeBound(objects, lower, upper);
  const double cell = (upper - lower).minCoeff() / k_cells;
  return std::make_unique<Hashing>(cell, lower, upper);
}

}  // namespace

void add_fcl_scenes(SceneAlgorithms& algorithms) {
  const auto add = [&](const char* name, const char* summary, ManagerKind kind, bool by_default = true) {
    algorithms.push_back(
        make_scene_algorithm<FclScene>({.name = name,
                                        .version = FCL_VERSION,
                                        .summary = fmt::format("FCL, {}; narrow phase fcl-obbrss", summary),
                                        .answers = {Question::touching, Question::near, Question::closest},
                                        .surfaces_only = true,
                                        .by_default = by_default},
                                       std::move(kind)));
  };
  add("fcl-naive", "all pairs of boxes", {make<fcl::NaiveCollisionManagerd>}, false);
  add("fcl-ssap", "sweep along one axis, sorted anew", {make<fcl::SSaPCollisionManagerd>});
  // Not by default: FCL 0.7 may never return from its update.
  add("fcl-sap", "sweep and prune", {make<fcl::SaPCollisionManagerd>}, false);
  add("fcl-hash", "spatial hashing", {make_hash});
  // FCL 0.7's update of single bodies frees the sentinel of its interval tree and goes on using it.
  add("fcl-interval-tree", "interval trees", {.make = make<fcl::IntervalTreeCollisionManagerd>, .updates_some = false});
  add("fcl-aabb-tree", "dynamic tree of boxes", {make<fcl::DynamicAABBTreeCollisionManagerd>});
  add("fcl-aabb-tree-array", "dynamic tree of boxes in an array", {make<fcl::DynamicAABBTreeCollisionManager_Arrayd>});
}

}  // namespace sixdof::scene
