#include <sixdof/scene/bullet/bullet_scene.h>

#include <memory>
#include <vector>

#include <fmt/format.h>

#include <sixdof/algorithm/bullet/bullet_mesh.h>
#include <sixdof/scene/bullet/any_contact.h>
#include <sixdof/scene/library_scene.h>

namespace sixdof::scene {
namespace {

/// The box around all bodies at all recorded poses.
Eigen::AlignedBox3d bounds_of(const Scene& scene) {
  Eigen::AlignedBox3d bounds;
  const auto add = [&](const Body& body, const RecordedPose& pose) {
    const Mesh& mesh = *scene.meshes[body.mesh];
    const Eigen::Vector3d center = pose.pose() * mesh.center();
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * mesh.diagonal());
    bounds.extend(center - half);
    bounds.extend(center + half);
  };
  for (const Body& body : scene.bodies) add(body, body.pose);
  for (const Frame& frame : scene.frames) {
    for (const Motion& motion : frame) add(scene.bodies[motion.body], motion.pose);
  }
  return bounds;
}

using MakeBroadphase = std::unique_ptr<btBroadphaseInterface> (*)(const Scene& scene);

class BulletScene final : public LibraryScene {
 public:
  BulletScene(const Scene& scene, Question /*question*/, MakeBroadphase make)
      : LibraryScene(scene),
        broadphase_(make(scene)),
        world_(std::make_unique<btCollisionWorld>(&pairs_.dispatcher(), broadphase_.get(), &pairs_.configuration())) {
    for (const auto& mesh : scene.meshes) meshes_.push_back(std::make_unique<GImpactMesh>(*mesh, 0.0));
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      auto& object = *objects_.emplace_back(std::make_unique<btCollisionObject>());
      object.setCollisionShape(meshes_[body.mesh]->shape());
      object.setWorldTransform(to_bullet(body.pose.pose()));
      object.setUserIndex(static_cast<int>(i));
      const int group = body.fixed ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter;
      const int mask =
          body.fixed ? btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter : btBroadphaseProxy::AllFilter;
      world_->addCollisionObject(&object, group, mask);
    }
  }
  BulletScene(const BulletScene&) = delete;
  BulletScene& operator=(const BulletScene&) = delete;
  ~BulletScene() override {
    for (const auto& object : objects_) world_->removeCollisionObject(object.get());
  }

  void move(std::span<const Moved> moved) override {
    for (const Moved& each : moved) {
      btCollisionObject& object = *objects_[each.body];
      object.setWorldTransform(to_bullet(each.X_WB));
      world_->updateSingleAabb(&object);
    }
  }

  void find() override {
    broadphase_->calculateOverlappingPairs(&pairs_.dispatcher());
    btOverlappingPairCache& pairs = *broadphase_->getOverlappingPairCache();
    for (int k = 0; k < pairs.getNumOverlappingPairs(); ++k) {
      const btBroadphasePair& pair = pairs.getOverlappingPairArrayPtr()[k];
      ask(static_cast<const btCollisionObject*>(pair.m_pProxy0->m_clientObject),
          static_cast<const btCollisionObject*>(pair.m_pProxy1->m_clientObject));
    }
  }

 private:
  void ask(const btCollisionObject* first, const btCollisionObject* second) {
    const auto i = static_cast<std::uint32_t>(first->getUserIndex());
    const auto j = static_cast<std::uint32_t>(second->getUserIndex());
    if (!is_asked(i, j)) return;
    const auto receiver = [](auto* a, auto* b) { return AnyContact(a, b); };
    if (pairs_.collide(*first, *second, receiver).found) take(i, j);
  }

  GImpactPairs pairs_;
  std::unique_ptr<btBroadphaseInterface> broadphase_;
  std::unique_ptr<btCollisionWorld> world_;
  std::vector<std::unique_ptr<GImpactMesh>> meshes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};

std::unique_ptr<btBroadphaseInterface> make_simple(const Scene& scene) {
  return std::make_unique<btSimpleBroadphase>(static_cast<int>(scene.bodies.size()) + 1);
}

std::unique_ptr<btBroadphaseInterface> make_dbvt(const Scene& /*scene*/) {
  return std::make_unique<btDbvtBroadphase>();
}

std::unique_ptr<btBroadphaseInterface> make_axis_sweep(const Scene& scene) {
  const Eigen::AlignedBox3d bounds = bounds_of(scene);
  return std::make_unique<bt32BitAxisSweep3>(to_bullet(bounds.min()), to_bullet(bounds.max()),
                                             static_cast<unsigned>(scene.bodies.size()) + 2);
}

}  // namespace

void add_bullet_scenes(SceneAlgorithms& algorithms) {
  const auto add = [&](const char* name, const char* summary, MakeBroadphase make, bool by_default = true) {
    algorithms.push_back(make_scene_algorithm<BulletScene>(
        {.name = name,
         .version = fmt::format("{}.{} double", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100),
         .summary = fmt::format("Bullet, {}; narrow phase bullet-gimpact", summary),
         .answers = {Question::touching},
         .surfaces_only = true,
         .by_default = by_default},
        make));
  };
  add("bullet-simple", "all pairs of boxes", make_simple, false);
  add("bullet-dbvt", "two dynamic trees of boxes", make_dbvt);
  add("bullet-axis-sweep", "sweep and prune on three axes", make_axis_sweep);
}

}  // namespace sixdof::scene
