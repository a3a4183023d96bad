// Bullet's GImpact in double precision as an algorithm under test: do two triangle surfaces meet? Margins are 0.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <btBulletCollisionCommon.h>
#include <sixdof/query/registrar.h>
#include <string>
#include "sixdof_commit.h"

struct Body : btTriangleMesh {
  explicit Body(const sixdof::Mesh& mesh) : shape(this) {
    const auto p = [&v = mesh.vertices()](auto i) { return btVector3(v[i][0], v[i][1], v[i][2]); };
    for (const auto& t : mesh.triangles()) addTriangle(p(t[0]), p(t[1]), p(t[2]));
    shape.setMargin(0.0);
    shape.updateBound();
    object.setCollisionShape(&shape);
  }
  btGImpactMeshShape shape;
  btCollisionObject object;
};

struct Contacts : btManifoldResult {
  using btManifoldResult::btManifoldResult;
  void addContactPoint(const btVector3&, const btVector3&, btScalar) override { found = true; }
  bool found = false;
};

struct GImpactQuery final : sixdof::Query {
  GImpactQuery(const sixdof::Mesh& a, const sixdof::Mesh& b, const sixdof::Settings&) : a_(a), b_(b) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
  }
  sixdof::Outcome<bool> collide(const sixdof::Pose& X) override {
    if (!is_finite(X)) return fail(sixdof::Status::non_finite, "the pose is not finite");
    b_.object.getWorldTransform().setFromOpenGLMatrix((Eigen::Matrix4d() << X.R, X.t, 0, 0, 0, 1).finished().data());
    const btCollisionObjectWrapper a(nullptr, &a_.shape, &a_.object, a_.object.getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper b(nullptr, &b_.shape, &b_.object, b_.object.getWorldTransform(), -1, -1);
    Contacts contacts(&a, &b);
    btCollisionAlgorithm* const algorithm = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    algorithm->processCollision(&a, &b, {}, &contacts);
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    return contacts.found;
  }
  Body a_, b_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
};

const sixdof::Registrar k_gimpact([] {
  return sixdof::make_algorithm<GImpactQuery>(
      {"gimpact", VERSION " " + std::string(k_short_commit), "Bullet's GImpact", sixdof::QuerySet{.collide = true}});
});
