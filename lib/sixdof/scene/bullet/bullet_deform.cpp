#include <sixdof/scene/bullet/bullet_deform.h>

#include <memory>
#include <vector>

#include <fmt/format.h>

#include <sixdof/algorithm/bullet/bullet_mesh.h>
#include <sixdof/scene/bullet/any_contact.h>
#include <sixdof/scene/library_deform.h>

namespace sixdof::scene {
namespace {

class BulletDeform final : public LibraryDeform {
 public:
  BulletDeform(const Scene& scene, Question /*question*/, bool refits) : LibraryDeform(scene), refits_(refits) {
    for (std::uint32_t i = 0; i < scene.meshes.size(); ++i) meshes_.push_back(new_mesh(i));
    for (const Body& body : scene.bodies) {
      auto& object = *objects_.emplace_back(std::make_unique<btCollisionObject>());
      object.setCollisionShape(meshes_[body.mesh]->shape());
      object.setWorldTransform(to_bullet(body.pose.pose()));
    }
  }

  void move(std::span<const Moved> moved) override {
    for (const Moved& each : moved) objects_[each.body]->setWorldTransform(to_bullet(each.X_WB));
  }

 private:
  std::unique_ptr<GImpactMesh> new_mesh(std::uint32_t mesh) const {
    return std::make_unique<GImpactMesh>(*scene_.meshes[mesh], 0.0, vertices_of(mesh));
  }

  void update_mesh(std::uint32_t mesh) override {
    if (refits_) return meshes_[mesh]->refit();
    meshes_[mesh] = new_mesh(mesh);
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (scene_.bodies[i].mesh == mesh) objects_[i]->setCollisionShape(meshes_[mesh]->shape());
    }
  }

  bool touch(std::uint32_t i, std::uint32_t j) override {
    const auto receiver = [](auto* a, auto* b) { return AnyContact(a, b); };
    return pairs_.collide(*objects_[i], *objects_[j], receiver).found;
  }

  const bool refits_;
  GImpactPairs pairs_;
  std::vector<std::unique_ptr<GImpactMesh>> meshes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};

}  // namespace

void add_bullet_deforms(SceneAlgorithms& algorithms) {
  const auto add = [&](const char* name, const char* summary, bool refits) {
    algorithms.push_back(make_scene_algorithm<BulletDeform>(
        {.name = name,
         .version = fmt::format("{}.{} double", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100),
         .summary = fmt::format("Bullet, bullet-gimpact, when a mesh deforms: {}", summary),
         .answers = {Question::touching},
         .surfaces_only = true,
         .deforms = true,
         .rigid = false},
        refits));
  };
  add("bullet-rebuild", "a new shape", false);
  add("bullet-refit", "boxes are fitted anew", true);
}

}  // namespace sixdof::scene
