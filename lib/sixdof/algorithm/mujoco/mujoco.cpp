#include <sixdof/algorithm/mujoco/mujoco.h>

#include <mujoco/mujoco.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <sixdof/algorithm/library_query.h>

namespace sixdof {
namespace {

[[noreturn]] void throw_error(const char* text) { throw std::runtime_error(fmt::format("MuJoCo: {}", text)); }
void ignore(const char* /*text*/) {}

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
struct DeleteFiles {
  void operator()(mjVFS* files) const {
    mj_deleteVFS(files);
    delete files;
  }
};
using Model = std::unique_ptr<mjModel, DeleteModel>;
using Data = std::unique_ptr<mjData, DeleteData>;

void append_vertices(const Mesh& mesh, std::string& xml) {
  for (const Eigen::Vector3d& v : mesh.vertices()) {
    fmt::format_to(std::back_inserter(xml), "{:.9g} {:.9g} {:.9g} ", v.x(), v.y(), v.z());
  }
}

/// MuJoCo lets Qhull print pages on a flat mesh. @throws BadMesh for one
void refuse_flat(const Mesh& mesh) {
  // Of the thickness by the extent: MuJoCo's vertices are floats.
  constexpr double k_least_thickness = 1e-6;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& v : mesh.vertices()) spread += (v - mesh.center()) * (v - mesh.center()).transpose();
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
  if (!(moments[0] > k_least_thickness * k_least_thickness * moments[2])) {
    throw BadMesh(mesh.name() + ": no convex hull: the vertices lie in a plane, or nearly so");
  }
}

/// Adds a file to those that mj_loadXML() reads. @throws Error if it cannot be added
void add_file(mjVFS& files, const char* name, const std::string& text) {
  const int size = static_cast<int>(text.size());
#if mjVERSION_HEADER >= 320
  const bool added = mj_addBufferVFS(&files, name, text.data(), size) == 0;
#else
  const bool added = mj_makeEmptyFileVFS(&files, name, size) == 0;
  if (added) std::ranges::copy(text, static_cast<char*>(files.filedata[mj_findFileVFS(&files, name)]));
#endif
  if (!added) throw Error("MuJoCo takes no model");
}

/// @throws BadMesh if MuJoCo refuses a mesh
Model compile(const Mesh& a, const Mesh& b) {
  std::string xml = "<mujoco><asset><mesh name='a' vertex='";
  append_vertices(a, xml);
  xml += "'/><mesh name='b' vertex='";
  append_vertices(b, xml);
  xml +=
      "'/></asset><worldbody><geom type='mesh' mesh='a'/>"
      "<body><freejoint/><geom type='mesh' mesh='b'/></body></worldbody></mujoco>";
  constexpr const char* k_file = "pair.xml";
  const std::unique_ptr<mjVFS, DeleteFiles> files(new mjVFS);
  mj_defaultVFS(files.get());
  add_file(*files, k_file, xml);
  char error[500] = "";
  Model model(mj_loadXML(k_file, files.get(), error, sizeof(error)));
  if (!model) throw BadMesh(fmt::format("{}, {}: MuJoCo refuses a mesh: {}", a.name(), b.name(), error));
  return model;
}

class MujocoQuery final : public LibraryQuery {
 public:
  MujocoQuery(const Mesh& a, const Mesh& b, const Settings& /*settings*/) {
    for (const Mesh* mesh : {&a, &b}) refuse_flat(*mesh);
    mju_user_error = &throw_error;
    mju_user_warning = &ignore;
    try {
      model_ = compile(a, b);
      data_.reset(mj_makeData(model_.get()));
    } catch (const std::runtime_error& e) {
      throw BadMesh(fmt::format("{}, {}: {}", a.name(), b.name(), e.what()));
    }
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    return guarded(X_AB, [&]() -> Outcome<bool> {
      std::copy_n(X_AB.t.data(), 3, data_->qpos);
      const Eigen::Vector4d q = X_AB.quaternion();
      std::copy_n(q.data(), 4, data_->qpos + 3);
      mj_kinematics(model_.get(), data_.get());
      mj_comPos(model_.get(), data_.get());
      mj_collision(model_.get(), data_.get());
      return data_->ncon > 0;
    });
  }

  Footprint footprint() const override {
    return {static_cast<std::size_t>(mj_sizeModel(model_.get())),
            {{"vertices", static_cast<double>(model_->nmeshvert)}}};
  }

 private:
  Model model_;
  Data data_;
};

}  // namespace

std::unique_ptr<Algorithm> make_mujoco_hull_algorithm() {
  return make_algorithm<MujocoQuery>({.name = "mujoco-hull",
                                      .version = fmt::format("{} float", mj_versionString()),
                                      .summary = "MuJoCo on the convex hulls of both meshes",
                                      .answers = {.collide = true},
                                      .body = Body::convex_hull});
}

void register_mujoco_algorithms(Registry& registry) { registry.add(make_mujoco_hull_algorithm()); }

}  // namespace sixdof
