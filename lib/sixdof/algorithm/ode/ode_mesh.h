#pragma once

#include <ode/ode.h>

#include <sixdof/algorithm/library_query.h>

/// Meshes and poses as ODE takes them. All is done under an OdeLock.

namespace sixdof {

/// Refers to the arrays of a mesh, which outlives it.
class OdeMesh {
 public:
  /// @param vertices read instead of the mesh's, as many; they outlive it and may move: see refit()
  /// @throws BadMesh if the mesh has more elements than ODE can count
  explicit OdeMesh(const Mesh& mesh, const Eigen::Vector3d* vertices = nullptr) : mesh_(mesh) {
    static_assert(sizeof(dReal) == sizeof(double), "ODE is compiled for double precision");
    static_assert(sizeof(Triangle) == 3 * sizeof(dTriIndex));
    require_countable(mesh, "ODE", 3);
    data_ = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(data_, vertices ? vertices : mesh.vertices().data(), sizeof(Eigen::Vector3d),
                                static_cast<int>(mesh.vertices().size()), mesh.triangles().data(),
                                3 * static_cast<int>(mesh.triangles().size()), sizeof(Triangle));
  }
  OdeMesh(const OdeMesh&) = delete;
  OdeMesh& operator=(const OdeMesh&) = delete;
  ~OdeMesh() { dGeomTriMeshDataDestroy(data_); }

  /// Fits the boxes of the tree to the vertices where they are now.
  void refit() { dGeomTriMeshDataUpdate(data_); }

  const Mesh& mesh() const { return mesh_; }
  dTriMeshDataID data() const { return data_; }
  /// A geometry in no space.
  dGeomID new_geometry() const { return dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr); }

 private:
  const Mesh& mesh_;
  dTriMeshDataID data_ = nullptr;
};

inline void place(dGeomID geometry, const Pose& pose) {
  dMatrix3 rotation = {};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation[4 * row + column] = pose.R(row, column);
  }
  dGeomSetRotation(geometry, rotation);
  dGeomSetPosition(geometry, pose.t.x(), pose.t.y(), pose.t.z());
}

}  // namespace sixdof
