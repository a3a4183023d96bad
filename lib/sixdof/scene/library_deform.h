#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <sixdof/scene/library_scene.h>

namespace sixdof::scene {

/// A scene of few bodies in a library that reads the vertices of its meshes where they are: every pair is asked whether
/// it touches, and a mesh that deforms has an array of vertices of its own, which updates overwrite.
class LibraryDeform : public LibraryScene {
 public:
  explicit LibraryDeform(const Scene& scene) : LibraryScene(scene) {
    for (std::uint32_t i = 0; i < scene.meshes.size(); ++i) {
      auto& own = vertices_.emplace_back();
      if (scene.deforms(i)) own = std::make_unique<std::vector<Eigen::Vector3d>>(scene.meshes[i]->vertices());
    }
  }

  void reshape(std::span<const Deformed> deformed) final {
    for (const Deformed& each : deformed) {
      std::ranges::copy(each.vertices, vertices_[each.mesh]->begin());
      update_mesh(each.mesh);
    }
  }

  void find() final {
    for (std::uint32_t j = 1; j < scene_.bodies.size(); ++j) {
      for (std::uint32_t i = 0; i < j; ++i) {
        if (is_asked(i, j) && touch(i, j)) take(i, j);
      }
    }
  }

 protected:
  /// Of a mesh that deforms where its vertices are now; null if it does not deform.
  const Eigen::Vector3d* vertices_of(std::uint32_t mesh) const {
    return vertices_[mesh] ? vertices_[mesh]->data() : nullptr;
  }
  /// The vertices of a mesh have moved.
  virtual void update_mesh(std::uint32_t mesh) = 0;
  /// Whether the surfaces of two bodies meet. @param i, j indices into Scene::bodies
  virtual bool touch(std::uint32_t i, std::uint32_t j) = 0;

 private:
  std::vector<std::unique_ptr<std::vector<Eigen::Vector3d>>> vertices_;
};

}  // namespace sixdof::scene
