#pragma once

#include <memory>

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <sixdof/algorithm/library_query.h>

/// Meshes, poses and pairs as Bullet's GImpact takes them.

namespace sixdof {

inline btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

inline btTransform to_bullet(const Pose& X) {
  const Eigen::Matrix3d& R = X.R;
  return btTransform(btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
                     to_bullet(X.t));
}

/// Refers to the arrays of a mesh, which outlives it.
class GImpactMesh {
 public:
  /// @param margin by which triangles are thickened (length)
  /// @param vertices read instead of the mesh's, as many; they outlive it and may move: see refit()
  /// @throws BadMesh if the mesh has more elements than Bullet can count
  GImpactMesh(const Mesh& mesh, double margin, const Eigen::Vector3d* vertices = nullptr) : mesh_(mesh) {
    static_assert(sizeof(Triangle) == 3 * sizeof(int));
    require_countable(mesh, "Bullet", 3);
    btIndexedMesh part;
    part.m_numTriangles = static_cast<int>(mesh.triangles().size());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(mesh.triangles().data());
    part.m_triangleIndexStride = sizeof(Triangle);
    part.m_numVertices = static_cast<int>(mesh.vertices().size());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices ? vertices : mesh.vertices().data());
    part.m_vertexStride = sizeof(Eigen::Vector3d);
    part.m_vertexType = PHY_DOUBLE;
    arrays_.addIndexedMesh(part, PHY_INTEGER);
    shape_ = std::make_unique<btGImpactMeshShape>(&arrays_);
    shape_->setMargin(margin);
    // Builds the tree.
    shape_->updateBound();
  }

  /// Fits the boxes of the tree to the vertices where they are now.
  void refit() {
    shape_->postUpdate();
    shape_->updateBound();
  }

  btGImpactMeshShape* shape() const { return shape_.get(); }
  const Mesh& mesh() const { return mesh_; }

 private:
  const Mesh& mesh_;
  btTriangleIndexVertexArray arrays_;
  std::unique_ptr<btGImpactMeshShape> shape_;
};

/// Finds the contacts of two bodies.
class GImpactPairs {
 public:
  GImpactPairs() { btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_); }

  btCollisionDispatcher& dispatcher() { return dispatcher_; }
  btCollisionConfiguration& configuration() { return configuration_; }

  /// @param receiver made by receiver(a, b), gets the contacts
  template <class MakeReceiver>
  auto collide(const btCollisionObject& object_a, const btCollisionObject& object_b, const MakeReceiver& receiver) {
    const auto wrap = [](const btCollisionObject& object) {
      return btCollisionObjectWrapper(nullptr, object.getCollisionShape(), &object, object.getWorldTransform(), -1, -1);
    };
    const btCollisionObjectWrapper a = wrap(object_a), b = wrap(object_b);
    auto result = receiver(&a, &b);
    btCollisionAlgorithm* const algorithm = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    algorithm->processCollision(&a, &b, info_, &result);
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    return result;
  }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDispatcherInfo info_;
};

}  // namespace sixdof
