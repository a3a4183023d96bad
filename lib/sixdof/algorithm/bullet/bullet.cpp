#include <sixdof/algorithm/bullet/bullet.h>

#include <fmt/format.h>

#include <sixdof/algorithm/bullet/bullet_cast.h>
#include <sixdof/algorithm/bullet/bullet_mesh.h>

namespace sixdof {
namespace {

static_assert(sizeof(btScalar) == sizeof(double), "Bullet is compiled for double precision");

constexpr const char* k_margin = "margin";

Eigen::Vector3d from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

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

class GImpactQuery final : public LibraryQuery {
 public:
  GImpactQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : center_b_(b.center()), wrench_(settings), meshes_(ShapePair<GImpactMesh>::of(a, b, [&](const Mesh& mesh) {
          return std::make_shared<GImpactMesh>(mesh, settings.number(k_margin));
        })) {
    body_a_.setCollisionShape(meshes_.a->shape());
    body_b_.setCollisionShape(meshes_.b->shape());
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if (const Status status = find_contacts(X_AB); status != Status::ok) return status;
    return wrench_.count() > 0;
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (const Status status = find_contacts(X_AB); status != Status::ok) return status;
    return response_of(wrench_);
  }

  Footprint footprint() const override {
    double nodes = 0.0, triangles = 0.0;
    meshes_.for_each([&](const GImpactMesh& each) {
      nodes += each.shape()->getMeshPart(0)->getBoxSet()->getNodeCount();
      triangles += static_cast<double>(each.mesh().triangles().size());
    });
    return {static_cast<std::size_t>(nodes) * sizeof(BT_QUANTIZED_BVH_NODE),
            {{"nodes", nodes}, {"triangles", triangles}}};
  }

 private:
  Status find_contacts(const Pose& X_AB) {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    body_b_.setWorldTransform(to_bullet(X_AB));
    wrench_.reset(X_AB * center_b_);
    pairs_.collide(body_a_, body_b_, [&](auto* a, auto* b) { return ContactReceiver(a, b, wrench_); });
    return Status::ok;
  }

  const Eigen::Vector3d center_b_;
  ContactWrench wrench_;
  const ShapePair<GImpactMesh> meshes_;
  GImpactPairs pairs_;
  btCollisionObject body_a_, body_b_;
};

}  // namespace

std::unique_ptr<Algorithm> make_bullet_gimpact_algorithm() {
  return make_algorithm<GImpactQuery>(
      {.name = "bullet-gimpact",
       .version = fmt::format("{}.{} double", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100),
       .summary = "Bullet's GImpact: contacts of triangle pairs as a penalty wrench",
       .answers = {.collide = true, .respond = true},
       .law = ResponseLaw::contacts,
       .limits = {.surfaces_only = {.collide = true, .respond = true}, .own_direction = true},
       .parameters = {ContactWrench::combine_parameter(),
                      Parameter::number(k_margin, "triangles are thickened by this length; Bullet's own default is 0.1",
                                        "length", "0", 0.0, 1e9)}});
}

void register_bullet_algorithms(Registry& registry) {
  registry.add(make_bullet_gimpact_algorithm());
  registry.add(make_bullet_hull_algorithm());
}

}  // namespace sixdof
