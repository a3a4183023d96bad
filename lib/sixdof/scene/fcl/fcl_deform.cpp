#include <sixdof/scene/fcl/fcl_deform.h>

#include <fcl/config.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>

#include <sixdof/algorithm/fcl/fcl_mesh.h>
#include <sixdof/base/error.h>
#include <sixdof/scene/library_scene.h>

namespace sixdof::scene {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

enum class FclUpdate {
  rebuild,
  refit,
  refit_top_down,
  update
};

class FclDeform final : public LibraryScene {
 public:
  FclDeform(const Scene& scene, Question question, FclUpdate how)
      : LibraryScene(scene), question_(question), how_(how) {
    for (const auto& mesh : scene.meshes) {
      models_.push_back(build_fcl_model<fcl::OBBRSSd>(*mesh));
      models_.back()->computeLocalAABB();
    }
    for (const Body& body : scene.bodies) transforms_.push_back(to_fcl(body.pose.pose()));
  }

  void reshape(std::span<const Deformed> deformed) override {
    for (const Deformed& each : deformed) {
      Model& model = *models_[each.mesh];
      vertices_.assign(each.vertices.begin(), each.vertices.end());
      int code = fcl::BVH_OK;
      if (how_ == FclUpdate::update) {
        code = model.beginUpdateModel();
        if (code == fcl::BVH_OK) code = model.updateSubModel(vertices_);
        if (code == fcl::BVH_OK) code = model.endUpdateModel(true, true);
      } else {
        code = model.beginReplaceModel();
        if (code == fcl::BVH_OK) code = model.replaceSubModel(vertices_);
        if (code == fcl::BVH_OK) {
          code = model.endReplaceModel(how_ != FclUpdate::rebuild, how_ != FclUpdate::refit_top_down);
        }
      }
      if (code != fcl::BVH_OK) throw Error(fmt::format("FCL cannot update a tree (code {})", code));
      model.computeLocalAABB();
    }
  }

  void move(std::span<const Moved> moved) override {
    for (const Moved& each : moved) transforms_[each.body] = to_fcl(each.X_WB);
  }

  void find() override {
    limit_ = question_ == Question::near ? scene_.margin : std::numeric_limits<double>::max();
    for (std::uint32_t j = 1; j < transforms_.size(); ++j) {
      for (std::uint32_t i = 0; i < j; ++i) {
        if (is_asked(i, j)) ask(i, j);
      }
    }
  }

 private:
  const Model* model_of(std::uint32_t body) const { return models_[scene_.bodies[body].mesh].get(); }

  void ask(std::uint32_t i, std::uint32_t j) {
    if (question_ == Question::touching) {
      fcl::CollisionResultd result;
      fcl::collide(model_of(i), transforms_[i], model_of(j), transforms_[j], fcl::CollisionRequestd(1, false), result);
      if (result.isCollision()) take(i, j);
      return;
    }
    fcl::DistanceResultd result;
    fcl::distance(model_of(i), transforms_[i], model_of(j), transforms_[j], fcl::DistanceRequestd(false), result);
    const double distance = std::max(result.min_distance, 0.0);
    if (distance > limit_) return;
    if (question_ == Question::closest) {
      forget_pairs();
      limit_ = distance;
    }
    take(i, j, distance);
  }

  const Question question_;
  const FclUpdate how_;
  std::vector<std::shared_ptr<Model>> models_;
  std::vector<fcl::Transform3d> transforms_;
  std::vector<Eigen::Vector3d> vertices_;  // as FCL takes them
  double limit_ = 0.0;
};

}  // namespace

void add_fcl_deforms(SceneAlgorithms& algorithms) {
  const auto add = [&](const char* name, const char* summary, FclUpdate how) {
    algorithms.push_back(
        make_scene_algorithm<FclDeform>({.name = name,
                                         .version = FCL_VERSION,
                                         .summary = fmt::format("FCL, fcl-obbrss, when a mesh deforms: {}", summary),
                                         .answers = {Question::touching, Question::near, Question::closest},
                                         .surfaces_only = true,
                                         .deforms = true,
                                         .rigid = false},
                                        how));
  };
  add("fcl-rebuild", "the tree is built anew", FclUpdate::rebuild);
  add("fcl-refit", "volumes are joined from below", FclUpdate::refit);
  add("fcl-refit-top-down", "each volume is fitted to its triangles", FclUpdate::refit_top_down);
  add("fcl-update", "volumes of this frame and the one before are joined from below", FclUpdate::update);
}

}  // namespace sixdof::scene
