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
template <class Add>
class ContactReceiver final : public btManifoldResult {
 public:
  /// @param add add(point, normal from A to B, depth)
  ContactReceiver(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b, const Add& add)
      : btManifoldResult(a, b), add_(add) {}

  /// The normal is on B, towards A.
  void addContactPoint(const btVector3& normal, const btVector3& point, btScalar distance) override {
    add_(from_bullet(point), Eigen::Vector3d(-from_bullet(normal)), -distance);
  }

 private:
  const Add& add_;
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

  /// GImpact cannot be told a number: the first that it finds.
  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override {
    Contacts found;
    const Status status = find_contacts(X_AB, [&](const auto& point, const auto& normal, double depth) {
      if (found.list.size() < most) found.list.push_back({point, normal, depth});
    });
    if (status != Status::ok) return status;
    return found;
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
  /// All of them become wrench_.
  Status find_contacts(const Pose& X_AB) {
    wrench_.reset(X_AB * center_b_);
    return find_contacts(
        X_AB, [&](const auto& point, const auto& normal, double depth) { wrench_.add(point, normal, depth); });
  }

  template <class Add>
  Status find_contacts(const Pose& X_AB, const Add& add) {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    body_b_.setWorldTransform(to_bullet(X_AB));
    pairs_.collide(body_a_, body_b_, [&](auto* a, auto* b) { return ContactReceiver<Add>(a, b, add); });
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
       .answers = {.collide = true, .respond = true, .contacts = true},
       .law = ResponseLaw::contacts,
       .depth = ContactDepth::triangles,
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
