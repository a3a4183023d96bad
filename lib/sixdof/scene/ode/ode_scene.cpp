#include <sixdof/scene/ode/ode_scene.h>

#include <memory>
#include <vector>

#include <fmt/format.h>

#include <sixdof/algorithm/ode/ode_lock.h>
#include <sixdof/algorithm/ode/ode_mesh.h>
#include <sixdof/scene/library_scene.h>

namespace sixdof::scene {
namespace {

/// Makes a space for bodies within the given bounds.
using MakeSpace = dSpaceID (*)(const Eigen::Vector3d& center, const Eigen::Vector3d& half);

class OdeScene final : public LibraryScene {
 public:
  OdeScene(const Scene& scene, Question /*question*/, MakeSpace make) : LibraryScene(scene) {
    const OdeLock lock;
    for (const auto& mesh : scene.meshes) meshes_.push_back(std::make_unique<OdeMesh>(*mesh));
    Eigen::AlignedBox3d bounds;
    for (const Body& body : scene.bodies) bounds.extend(body.pose.pose().t);
    moving_ = make(bounds.center(), 0.5 * bounds.sizes());
    fixed_ = make(bounds.center(), 0.5 * bounds.sizes());
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      const dGeomID geometry = meshes_[body.mesh]->new_geometry();
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
    meshes_.clear();
  }

  void move(std::span<const Moved> moved) override {
    const OdeLock lock;
    for (const Moved& each : moved) place(geometries_[each.body], each.X_WB);
  }

  void find() override {
    const OdeLock lock;
    dSpaceCollide(moving_, this, &on_pair);
    if (dSpaceGetNumGeoms(fixed_) > 0) {
      dSpaceCollide2(reinterpret_cast<dGeomID>(moving_), reinterpret_cast<dGeomID>(fixed_), this, &on_pair);
    }
  }

 private:
  static void on_pair(void* self, dGeomID a, dGeomID b) {
    auto& scene = *static_cast<OdeScene*>(self);
    const auto index = [](dGeomID geometry) {
      return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(dGeomGetData(geometry)));
    };
    const std::uint32_t i = index(a), j = index(b);
    if (!scene.is_asked(i, j)) return;
    dContactGeom contact;
    if (dCollide(a, b, 1 | static_cast<int>(CONTACTS_UNIMPORTANT), &contact, sizeof(contact)) > 0) scene.take(i, j);
  }

  std::vector<std::unique_ptr<OdeMesh>> meshes_;
  dSpaceID moving_ = nullptr, fixed_ = nullptr;
  std::vector<dGeomID> geometries_;
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
