#include <sixdof/scene/ode/ode_deform.h>

#include <memory>
#include <vector>

#include <fmt/format.h>

#include <sixdof/algorithm/ode/ode_lock.h>
#include <sixdof/algorithm/ode/ode_mesh.h>
#include <sixdof/scene/library_deform.h>

namespace sixdof::scene {
namespace {

class OdeDeform final : public LibraryDeform {
 public:
  OdeDeform(const Scene& scene, Question /*question*/, bool refits) : LibraryDeform(scene), refits_(refits) {
    const OdeLock lock;
    for (std::uint32_t i = 0; i < scene.meshes.size(); ++i) meshes_.push_back(new_mesh(i));
    for (const Body& body : scene.bodies) {
      geometries_.push_back(meshes_[body.mesh]->new_geometry());
      place(geometries_.back(), body.pose.pose());
    }
  }
  OdeDeform(const OdeDeform&) = delete;
  OdeDeform& operator=(const OdeDeform&) = delete;

  ~OdeDeform() override {
    const OdeLock lock;
    for (const dGeomID geometry : geometries_) dGeomDestroy(geometry);
    meshes_.clear();
  }

  void move(std::span<const Moved> moved) override {
    const OdeLock lock;
    for (const Moved& each : moved) place(geometries_[each.body], each.X_WB);
  }

 private:
  std::unique_ptr<OdeMesh> new_mesh(std::uint32_t mesh) const {
    return std::make_unique<OdeMesh>(*scene_.meshes[mesh], vertices_of(mesh));
  }

  void update_mesh(std::uint32_t mesh) override {
    const OdeLock lock;
    if (refits_) return meshes_[mesh]->refit();
    auto made = new_mesh(mesh);
    for (std::size_t i = 0; i < geometries_.size(); ++i) {
      if (scene_.bodies[i].mesh == mesh) dGeomTriMeshSetData(geometries_[i], made->data());
    }
    meshes_[mesh] = std::move(made);
  }

  bool touch(std::uint32_t i, std::uint32_t j) override {
    const OdeLock lock;
    dContactGeom contact;
    return dCollide(geometries_[i], geometries_[j], 1 | static_cast<int>(CONTACTS_UNIMPORTANT), &contact,
                    sizeof(contact)) > 0;
  }

  const bool refits_;
  std::vector<std::unique_ptr<OdeMesh>> meshes_;
  std::vector<dGeomID> geometries_;
};

}  // namespace

void add_ode_deforms(SceneAlgorithms& algorithms) {
  const auto add = [&](const char* name, const char* summary, bool refits) {
    algorithms.push_back(
        make_scene_algorithm<OdeDeform>({.name = name,
                                         .version = SIXDOF_ODE_VERSION " double",
                                         .summary = fmt::format("ODE, when a mesh deforms: {}", summary),
                                         .answers = {Question::touching},
                                         .surfaces_only = true,
                                         .deforms = true,
                                         .rigid = false},
                                        refits));
  };
  add("ode-rebuild", "new data", false);
  add("ode-refit", "OPCODE fits its boxes anew", true);
}

}  // namespace sixdof::scene
