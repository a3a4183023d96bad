#include <sixdof/scene/ode/ode_scene.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <ode/ode.h>

#include <sixdof/algorithm/ode/ode_lock.h>

namespace sixdof::scene {
namespace {

/// Makes a space for bodies within the given bounds.
using MakeSpace = dSpaceID (*)(const Eigen::Vector3d& center, const Eigen::Vector3d& half);

class OdeScene final : public SceneQuery {
 public:
  OdeScene(const Scene& scene, Question /*question*/, MakeSpace make) : scene_(scene), filter_(scene) {
    const OdeLock lock;
    for (const auto& mesh : scene.meshes) {
      data_.push_back(dGeomTriMeshDataCreate());
      static_assert(sizeof(dReal) == sizeof(double) && sizeof(Triangle) == 3 * sizeof(dTriIndex));
      dGeomTriMeshDataBuildDouble(data_.back(), mesh->vertices().data(), sizeof(Eigen::Vector3d),
                                  static_cast<int>(mesh->vertices().size()), mesh->triangles().data(),
                                  3 * static_cast<int>(mesh->triangles().size()), sizeof(Triangle));
    }
    Eigen::AlignedBox3d bounds;
    for (const Body& body : scene.bodies) bounds.extend(body.pose.pose().t);
    moving_ = make(bounds.center(), 0.5 * bounds.sizes());
    fixed_ = make(bounds.center(), 0.5 * bounds.sizes());
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      const dGeomID geometry = dCreateTriMesh(nullptr, data_[body.mesh], nullptr, nullptr, nullptr);
      dGeomSetData(geometry, reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
      place(geometry, body.pose.pose());
      dSpaceAdd(body.fixed ? fixed_ : moving_, geometry);
      geometries_.push_back(geometry);
    }
  }
  OdeScene(const OdeScene&) = delete;
  OdeScene& operator=(const OdeScene&) = delete;

  ~OdeScene() override {
    const OdeLock lock;
    // A space destroys what is in it.
    dSpaceDestroy(moving_);
    dSpaceDestroy(fixed_);
    for (const dTriMeshDataID data : data_) dGeomTriMeshDataDestroy(data);
  }

  void update(std::span<const Moved> moved) override {
    if (moved.empty()) return;
    known_ = false;
    const OdeLock lock;
    for (const Moved& each : moved) place(geometries_[each.body], each.X_WB);
  }

  const SceneAnswer& answer() override {
    if (std::exchange(known_, true)) return answer_;
    const OdeLock lock;
    answer_.pairs.clear();
    dSpaceCollide(moving_, this, &on_pair);
    if (dSpaceGetNumGeoms(fixed_) > 0) {
      dSpaceCollide2(reinterpret_cast<dGeomID>(moving_), reinterpret_cast<dGeomID>(fixed_), this, &on_pair);
    }
    std::ranges::sort(answer_.pairs);
    const auto twice = std::ranges::unique(answer_.pairs);
    answer_.pairs.erase(twice.begin(), twice.end());
    return answer_;
  }

  SceneWork work() const override { return work_; }

 private:
  static void place(dGeomID geometry, const Pose& pose) {
    dMatrix3 rotation = {};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) rotation[4 * row + column] = pose.R(row, column);
    }
    dGeomSetRotation(geometry, rotation);
    dGeomSetPosition(geometry, pose.t.x(), pose.t.y(), pose.t.z());
  }

  static void on_pair(void* self, dGeomID a, dGeomID b) {
    auto& scene = *static_cast<OdeScene*>(self);
    const auto index = [](dGeomID geometry) {
      return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(dGeomGetData(geometry)));
    };
    const std::uint32_t i = index(a), j = index(b);
    ++scene.work_.candidates;
    if (!scene.filter_.matters(i, j)) return;
    ++scene.work_.narrow;
    dContactGeom contact;
    if (dCollide(a, b, 1 | static_cast<int>(CONTACTS_UNIMPORTANT), &contact, sizeof(contact)) == 0) return;
    scene.answer_.pairs.push_back({BodyPair::of(scene.scene_.bodies[i].id, scene.scene_.bodies[j].id), 0.0});
  }

  const Scene& scene_;
  const PairFilter filter_;
  std::vector<dTriMeshDataID> data_;
  dSpaceID moving_ = nullptr, fixed_ = nullptr;
  std::vector<dGeomID> geometries_;
  bool known_ = false;
  SceneAnswer answer_;
  SceneWork work_;
};

dSpaceID make_quadtree(const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
  constexpr int k_depth = 6;                // 4096 cells at the bottom
  const Eigen::Vector3d wide = 1.5 * half;  // bodies that leave the bounds of the start
  const dVector3 middle = {center.x(), center.y(), center.z(), 0.0};
  const dVector3 extents = {wide.x(), wide.y(), wide.z(), 0.0};
  return dQuadTreeSpaceCreate(nullptr, middle, extents, k_depth);
}

}  // namespace

void add_ode_scenes(SceneAlgorithms& algorithms) {
  const auto add = [&](const char* name, const char* summary, MakeSpace make, bool by_default = true) {
    algorithms.push_back(make_scene_algorithm<OdeScene>({.name = name,
                                                         .version = SIXDOF_ODE_VERSION " double",
                                                         .summary = fmt::format("ODE, {}; narrow phase ode", summary),
                                                         .answers = {Question::touching},
                                                         .surfaces_only = true,
                                                         .by_default = by_default},
                                                        make));
  };
  using Vector = Eigen::Vector3d;
  add(
      "ode-simple", "all pairs of boxes", [](const Vector&, const Vector&) { return dSimpleSpaceCreate(nullptr); },
      false);
  add("ode-hash", "hash space of several resolutions",
      [](const Vector&, const Vector&) { return dHashSpaceCreate(nullptr); });
  add("ode-quadtree", "quadtree space", make_quadtree);
  add("ode-sap", "sweep and prune",
      [](const Vector&, const Vector&) { return dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ); });
}

}  // namespace sixdof::scene
