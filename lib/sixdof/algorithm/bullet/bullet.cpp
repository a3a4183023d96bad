#include <sixdof/algorithm/bullet/bullet.h>

#include <limits>
#include <string>

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>
#include <fmt/format.h>

#include <sixdof/algorithm/contact_wrench.h>
#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr const char* k_margin = "margin";

btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Vector3d from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// Refers to the arrays of a mesh, which outlives it.
class GImpactShape {
 public:
  /// @throws BadMesh if the mesh has more elements than Bullet can count
  GImpactShape(const Mesh& mesh, double margin) : mesh_(checked(mesh)) {
    btIndexedMesh part;
    part.m_numTriangles = static_cast<int>(mesh_.triangles().size());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(mesh_.triangles().data());
    part.m_triangleIndexStride = sizeof(Triangle);
    part.m_numVertices = static_cast<int>(mesh_.vertices().size());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(mesh_.vertices().data());
    part.m_vertexStride = sizeof(Eigen::Vector3d);
    part.m_vertexType = PHY_DOUBLE;
    arrays_.addIndexedMesh(part, PHY_INTEGER);
    shape_ = std::make_unique<btGImpactMeshShape>(&arrays_);
    shape_->setMargin(margin);
    // Builds the tree.
    shape_->updateBound();
  }

  btGImpactMeshShape* get() const { return shape_.get(); }
  const Mesh& mesh() const { return mesh_; }
  int nodes() const { return shape_->getMeshPart(0)->getBoxSet()->getNodeCount(); }

 private:
  static const Mesh& checked(const Mesh& mesh) {
    // Nodes and indices are counted in int.
    constexpr auto k_max_count = static_cast<std::size_t>(std::numeric_limits<int>::max()) / 3;
    if (mesh.triangles().size() > k_max_count || mesh.vertices().size() > k_max_count) {
      throw BadMesh(fmt::format("{}: more triangles or vertices than Bullet can count", mesh.name()));
    }
    return mesh;
  }

  static_assert(sizeof(btScalar) == sizeof(double), "Bullet is compiled for double precision");
  static_assert(sizeof(Triangle) == 3 * sizeof(int));
  const Mesh& mesh_;
  btTriangleIndexVertexArray arrays_;
  std::unique_ptr<btGImpactMeshShape> shape_;
};

/// Receives every contact that GImpact finds.
class ContactReceiver final : public btManifoldResult {
 public:
  ContactReceiver(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b, ContactWrench& wrench)
      : btManifoldResult(a, b), wrench_(wrench) {}

  /// The normal is on B, towards A.
  void addContactPoint(const btVector3& normal, const btVector3& point, btScalar distance) override {
    wrench_.add(from_bullet(point), -from_bullet(normal), -distance);
  }

 private:
  ContactWrench& wrench_;
};

class GImpactQuery final : public Query {
 public:
  GImpactQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : center_b_(b.center()),
        wrench_(settings),
        shape_a_(std::make_shared<GImpactShape>(a, settings.number(k_margin))),
        shape_b_(a.hash() == b.hash() ? shape_a_ : std::make_shared<GImpactShape>(b, settings.number(k_margin))) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    body_a_.setCollisionShape(shape_a_->get());
    body_b_.setCollisionShape(shape_b_->get());
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if (const Status status = find_contacts(X_AB); status != Status::ok) return status;
    return wrench_.count() > 0;
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (const Status status = find_contacts(X_AB); status != Status::ok) return status;
    const Response response = wrench_.response();
    if (!response.force.allFinite() || !response.torque.allFinite()) {
      return fail(Status::non_finite, "a contact is not finite");
    }
    return response;
  }

  Footprint footprint() const override {
    double nodes = 0.0, triangles = 0.0;
    for (const auto* shape : {shape_a_.get(), shape_a_ == shape_b_ ? nullptr : shape_b_.get()}) {
      if (shape == nullptr) continue;
      nodes += shape->nodes();
      triangles += static_cast<double>(shape->mesh().triangles().size());
    }
    return {static_cast<std::size_t>(nodes) * sizeof(BT_QUANTIZED_BVH_NODE),
            {{"nodes", nodes}, {"triangles", triangles}}};
  }

 private:
  Status find_contacts(const Pose& X_AB) {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    const Eigen::Matrix3d& R = X_AB.R;
    const btMatrix3x3 rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2));
    body_b_.setWorldTransform(btTransform(rotation, to_bullet(X_AB.t)));
    wrench_.reset(X_AB * center_b_);
    const btCollisionObjectWrapper a(nullptr, shape_a_->get(), &body_a_, body_a_.getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper b(nullptr, shape_b_->get(), &body_b_, body_b_.getWorldTransform(), -1, -1);
    ContactReceiver receiver(&a, &b, wrench_);
    btCollisionAlgorithm* const algorithm = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    algorithm->processCollision(&a, &b, info_, &receiver);
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    return Status::ok;
  }

  const Eigen::Vector3d center_b_;
  ContactWrench wrench_;
  const std::shared_ptr<const GImpactShape> shape_a_, shape_b_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDispatcherInfo info_;
  btCollisionObject body_a_, body_b_;
};

}  // namespace

std::unique_ptr<Algorithm> make_bullet_gimpact_algorithm() {
  return make_algorithm<GImpactQuery>(
      {.name = "bullet-gimpact",
       .version = fmt::format("{}.{} double", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100),
       .summary = "Bullet's GImpact: contacts of triangle pairs as a penalty wrench",
       .answers = {.collide = true, .respond = true},
       .law = ResponseLaw::depth,
       .limits = {.surfaces_only = {.collide = true, .respond = true}, .own_direction = true},
       .parameters = {ContactWrench::combine_parameter(),
                      Parameter::number(k_margin, "triangles are thickened by this length; Bullet's own default is 0.1",
                                        "length", "0", 0.0, 1e9)}});
}

void register_bullet_algorithms(Registry& registry) { registry.add(make_bullet_gimpact_algorithm()); }

}  // namespace sixdof
