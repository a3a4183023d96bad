#pragma once

#include <limits>
#include <memory>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/mesh.h>

/// Shared by the sources of this folder only, which keeps FCL's headers out of the interface.
namespace sixdof::fcl_backend {

template <class BV>
using Model = fcl::BVHModel<BV>;

/// @throws BadMesh if FCL refuses the mesh
template <class BV>
std::shared_ptr<const Model<BV>> build_model(const Mesh& mesh) {
  // FCL counts in int.
  constexpr auto k_max_count = static_cast<std::size_t>(std::numeric_limits<int>::max()) / 2;
  if (mesh.triangles().size() > k_max_count || mesh.vertices().size() > k_max_count) {
    throw BadMesh(fmt::format("{}: more triangles or vertices than FCL can count", mesh.name()));
  }
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles().size());
  for (const Triangle& t : mesh.triangles()) triangles.emplace_back(t[0], t[1], t[2]);

  const auto model = std::make_shared<Model<BV>>();
  int code = model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices().size()));
  if (code == fcl::BVH_OK) code = model->addSubModel(mesh.vertices(), triangles);
  if (code == fcl::BVH_OK) code = model->endModel();
  if (code != fcl::BVH_OK) throw BadMesh(fmt::format("{}: FCL cannot build a tree (code {})", mesh.name(), code));
  return model;
}

/// FCL's own memUsage() returns a status instead of a size, so the arrays are counted here.
template <class BV>
std::size_t bytes_of(const Model<BV>& model) {
  const auto nodes = static_cast<std::size_t>(model.getNumBVs());
  const auto triangles = static_cast<std::size_t>(model.num_tris);
  const auto vertices = static_cast<std::size_t>(model.num_vertices);
  return sizeof(Model<BV>) + nodes * sizeof(fcl::BVNode<BV>) + triangles * (sizeof(fcl::Triangle) + sizeof(unsigned)) +
         vertices * sizeof(fcl::Vector3d);
}

}  // namespace sixdof::fcl_backend
