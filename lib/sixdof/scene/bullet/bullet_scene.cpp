#include <sixdof/scene/bullet/bullet_scene.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>
#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof::scene {
namespace {

btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

btTransform to_bullet(const Pose& X) {
  const Eigen::Matrix3d& R = X.R;
  return btTransform(btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
                     to_bullet(X.t));
}

/// Refers to the arrays of a mesh, which outlives it.
struct MeshShape {
  explicit MeshShape(const Mesh& mesh) {
    static_assert(sizeof(btScalar) == sizeof(double) && sizeof(Triangle) == 3 * sizeof(int));
    btIndexedMesh part;
    part.m_numTriangles = static_cast<int>(mesh.triangles().size());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(mesh.triangles().data());
    part.m_triangleIndexStride = sizeof(Triangle);
    part.m_numVertices = static_cast<int>(mesh.vertices().size());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(mesh.vertices().data());
    part.m_vertexStride = sizeof(Eigen::Vector3d);
    part.m_vertexType = PHY_DOUBLE;
    arrays.addIndexedMesh(part, PHY_INTEGER);
    shape = std::make_unique<btGImpactMeshShape>(&arrays);
    shape->setMargin(0.0);
    shape->updateBound();
  }
  btTriangleIndexVertexArray arrays;
  std::unique_ptr<btGImpactMeshShape> shape;
};

/// Whether there is any contact.
class AnyContact final : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;
  void addContactPoint(const btVector3& /*normal*/, const btVector3& /*point*/, btScalar /*distance*/) override {
    found = true;
  }
  bool found = false;
};

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

class BulletScene final : public SceneQuery {
 public:
  BulletScene(const Scene& scene, Question /*question*/, MakeBroadphase make)
      : scene_(scene),
        filter_(scene),
        broadphase_(make(scene)),
        world_(std::make_unique<btCollisionWorld>(&dispatcher_, broadphase_.get(), &configuration_)) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    for (const auto& mesh : scene.meshes) shapes_.push_back(std::make_unique<MeshShape>(*mesh));
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      auto& object = *objects_.emplace_back(std::make_unique<btCollisionObject>());
      object.setCollisionShape(shapes_[body.mesh]->shape.get());
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

  void update(std::span<const Moved> moved) override {
    if (moved.empty()) return;
    known_ = false;
    for (const Moved& each : moved) {
      btCollisionObject& object = *objects_[each.body];
      object.setWorldTransform(to_bullet(each.X_WB));
      world_->updateSingleAabb(&object);
    }
  }

  const SceneAnswer& answer() override {
    if (std::exchange(known_, true)) return answer_;
    answer_.pairs.clear();
    broadphase_->calculateOverlappingPairs(&dispatcher_);
    btOverlappingPairCache& pairs = *broadphase_->getOverlappingPairCache();
    for (int k = 0; k < pairs.getNumOverlappingPairs(); ++k) {
      const btBroadphasePair& pair = pairs.getOverlappingPairArrayPtr()[k];
      ask(static_cast<const btCollisionObject*>(pair.m_pProxy0->m_clientObject),
          static_cast<const btCollisionObject*>(pair.m_pProxy1->m_clientObject));
    }
    std::ranges::sort(answer_.pairs);
    return answer_;
  }

  SceneWork work() const override { return work_; }

 private:
  void ask(const btCollisionObject* first, const btCollisionObject* second) {
    const auto i = static_cast<std::uint32_t>(first->getUserIndex());
    const auto j = static_cast<std::uint32_t>(second->getUserIndex());
    ++work_.candidates;
    if (!filter_.matters(i, j)) return;
    ++work_.narrow;
    const btCollisionObjectWrapper a(nullptr, first->getCollisionShape(), first, first->getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper b(nullptr, second->getCollisionShape(), second, second->getWorldTransform(), -1, -1);
    AnyContact result(&a, &b);
    btCollisionAlgorithm* const algorithm = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    algorithm->processCollision(&a, &b, info_, &result);
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    if (result.found) answer_.pairs.push_back({BodyPair::of(scene_.bodies[i].id, scene_.bodies[j].id), 0.0});
  }

  const Scene& scene_;
  const PairFilter filter_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDispatcherInfo info_;
  std::unique_ptr<btBroadphaseInterface> broadphase_;
  std::unique_ptr<btCollisionWorld> world_;
  std::vector<std::unique_ptr<MeshShape>> shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  bool known_ = false;
  SceneAnswer answer_;
  SceneWork work_;
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
