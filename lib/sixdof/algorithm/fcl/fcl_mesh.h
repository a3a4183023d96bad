#pragma once

#include <memory>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fmt/format.h>

#include <sixdof/algorithm/library_query.h>

/// Meshes and poses as FCL takes them.

namespace sixdof {

/// @throws BadMesh if FCL refuses the mesh
template <class BV>
std::shared_ptr<fcl::BVHModel<BV>> build_fcl_model(const Mesh& mesh) {
  require_countable(mesh, "FCL", 2);
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles().size());
  for (const Triangle& t : mesh.triangles()) triangles.emplace_back(t[0], t[1], t[2]);
  const auto model = std::make_shared<fcl::BVHModel<BV>>();
  int code = model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices().size()));
  if (code == fcl::BVH_OK) code = model->addSubModel(mesh.vertices(), triangles);
  if (code == fcl::BVH_OK) code = model->endModel();
  if (code != fcl::BVH_OK) throw BadMesh(fmt::format("{}: FCL cannot build a tree (code {})", mesh.name(), code));
  return model;
}

inline fcl::Transform3d to_fcl(const Pose& pose) {
  fcl::Transform3d X = fcl::Transform3d::Identity();
  X.linear() = pose.R;
  X.translation() = pose.t;
  return X;
}

}  // namespace sixdof
