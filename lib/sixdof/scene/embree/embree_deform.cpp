#include <sixdof/scene/embree/embree_deform.h>

#include <memory>
#include <vector>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <sixdof/algorithm/embree/embree_mesh.h>
#include <sixdof/scene/library_deform.h>

namespace sixdof::scene {
namespace {

/// @throws Error for the device's last error
void check(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) throw Error(fmt::format("Embree error {}", static_cast<int>(error)));
}

class EmbreeDeform final : public LibraryDeform {
 public:
  EmbreeDeform(const Scene& scene, Question /*question*/, RTCBuildQuality quality)
      : LibraryDeform(scene), device_(rtcNewDevice("threads=1")), changed_(scene.bodies.size(), true) {
    check(nullptr);
    const RTCSceneFlags flags = quality == RTC_BUILD_QUALITY_REFIT ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE;
    for (const auto& mesh : scene.meshes) require_embree_range(*mesh);
    one_thread_.execute([&] {
      for (const Body& body : scene.bodies) {
        poses_.push_back(body.pose.pose());
        bodies_.push_back(std::make_unique<EmbreeMesh>(
            device_.get(), *scene.meshes[body.mesh], flags,
            quality == RTC_BUILD_QUALITY_REFIT ? RTC_BUILD_QUALITY_LOW : quality, quality));
      }
    });
    commit();
  }

  void move(std::span<const Moved> moved) override {
    for (const Moved& each : moved) {
      poses_[each.body] = each.X_WB;
      changed_[each.body] = true;
    }
    commit();
  }

 private:
  /// A frame in which a mesh deforms also moves bodies: they are committed once, in move(), or else before a query.
  void update_mesh(std::uint32_t mesh) override {
    for (std::size_t i = 0; i < changed_.size(); ++i) {
      if (scene_.bodies[i].mesh == mesh) changed_[i] = true;
    }
    has_changed_ = true;
  }

  void commit() {
    has_changed_ = false;
    one_thread_.execute([&] {
      for (std::size_t i = 0; i < changed_.size(); ++i) {
        if (!changed_[i]) continue;
        changed_[i] = false;
        const std::uint32_t mesh = scene_.bodies[i].mesh;
        const std::vector<Eigen::Vector3d>& rest = scene_.meshes[mesh]->vertices();
        const Eigen::Vector3d* const own = vertices_of(mesh);
        const char* const why_not = bodies_[i]->move(poses_[i], {own != nullptr ? own : rest.data(), rest.size()});
        if (why_not != nullptr) throw BadMesh(why_not);
      }
    });
    check(device_.get());
  }

  bool touch(std::uint32_t i, std::uint32_t j) override {
    if (has_changed_) commit();
    found_ = false;
    a_ = bodies_[i].get();
    b_ = bodies_[j].get();
    one_thread_.execute([&] { rtcCollide(a_->scene(), b_->scene(), &receive, this); });
    check(device_.get());
    return found_;
  }

  static void receive(void* self, RTCCollision* pairs, unsigned count) {
    auto& scene = *static_cast<EmbreeDeform*>(self);
    for (unsigned k = 0; k < count && !scene.found_; ++k) {
      scene.found_ = triangles_meet(scene.a_->corners(pairs[k].primID0), scene.b_->corners(pairs[k].primID1));
    }
  }

  tbb::task_arena one_thread_{1};
  const EmbreeDevice device_;
  std::vector<Pose> poses_;
  std::vector<std::unique_ptr<EmbreeMesh>> bodies_;
  std::vector<bool> changed_;
  bool has_changed_ = false;
  const EmbreeMesh* a_ = nullptr;
  const EmbreeMesh* b_ = nullptr;
  bool found_ = false;
};

}  // namespace

void add_embree_deforms(SceneAlgorithms& algorithms) {
  const auto add = [&](const char* name, const char* summary, RTCBuildQuality quality) {
    algorithms.push_back(make_scene_algorithm<EmbreeDeform>(
        {.name = name,
         .version = RTC_VERSION_STRING " float",
         .summary = fmt::format("Embree's rtcCollide, when a mesh deforms or moves: {}", summary),
         .answers = {Question::touching},
         .surfaces_only = true,
         .deforms = true,
         .rigid = false},
        quality));
  };
  add("embree-rebuild", "the tree is built anew, quality medium", RTC_BUILD_QUALITY_MEDIUM);
  add("embree-rebuild-fast", "the tree is built anew, quality low", RTC_BUILD_QUALITY_LOW);
  add("embree-refit", "quality refit", RTC_BUILD_QUALITY_REFIT);
}

}  // namespace sixdof::scene
