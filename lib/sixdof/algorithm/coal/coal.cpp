#include <sixdof/algorithm/coal/coal.h>

#include <coal/BVH/BVH_model.h>
#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/config.hh>

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/algorithm/library_query.h>

namespace sixdof {
namespace {

constexpr const char* k_profile = "profile";
constexpr const char* k_max_contacts = "max_contacts";

using Model = coal::BVHModel<coal::OBBRSS>;
using Scalar = coal::Vec3s::Scalar;
/// Its name differs between versions of Coal.
using CoalTriangle = std::decay_t<decltype(std::declval<Model>().tri_indices->front())>;

/// @throws BadMesh if Coal refuses the mesh
std::shared_ptr<const Model> build_model(const Mesh& mesh) {
  require_countable(mesh, "Coal", 2);
  std::vector<coal::Vec3s> vertices;
  for (const Eigen::Vector3d& v : mesh.vertices()) vertices.emplace_back(v.cast<Scalar>());
  std::vector<CoalTriangle> triangles;
  for (const Triangle& t : mesh.triangles()) triangles.emplace_back(t[0], t[1], t[2]);
  const auto model = std::make_shared<Model>();
  int code = model->beginModel(static_cast<unsigned>(triangles.size()), static_cast<unsigned>(vertices.size()));
  if (code == coal::BVH_OK) code = model->addSubModel(vertices, triangles);
  if (code == coal::BVH_OK) code = model->endModel();
  if (code != coal::BVH_OK) throw BadMesh(fmt::format("{}: Coal cannot build a tree (code {})", mesh.name(), code));
  return model;
}

/// The trees of both bodies. Equal meshes share one.
class CoalQuery : public LibraryQuery {
 public:
  Footprint footprint() const override {
    double nodes = 0.0, triangles = 0.0;
    models_.for_each([&](const Model& model) {
      nodes += model.getNumBVs();
      triangles += model.num_tris;
    });
    return {static_cast<std::size_t>(nodes) * sizeof(coal::BVNode<coal::OBBRSS>),
            {{"nodes", nodes}, {"triangles", triangles}}};
  }

 protected:
  CoalQuery(const Mesh& a, const Mesh& b) : models_(ShapePair<Model>::of(a, b, build_model)) {}

  /// guarded(), with X_AB_ set.
  template <class Answer>
  auto at(const Pose& X_AB, const Answer& answer) -> decltype(answer()) {
    X_AB_ = coal::Transform3s(X_AB.R.cast<Scalar>(), X_AB.t.cast<Scalar>());
    return guarded(X_AB, answer);
  }

  const ShapePair<Model> models_;
  const coal::Transform3s X_AA_;
  coal::Transform3s X_AB_;
};

class ObbrssQuery final : public CoalQuery {
 public:
  ObbrssQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : CoalQuery(a, b),
        is_tuned_(settings.choice(k_profile) == "tuned"),
        collide_(models_.a.get(), models_.b.get()),
        distance_(models_.a.get(), models_.b.get()) {
    if (!is_tuned_) return;
    collision_request_.enable_contact = false;
    collision_request_.gjk_initial_guess = coal::GJKInitialGuess::CachedGuess;
    distance_request_.gjk_initial_guess = coal::GJKInitialGuess::CachedGuess;
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    return at(X_AB, [&]() -> Outcome<bool> {
      coal::CollisionResult result;
      if (is_tuned_) {
        collide_(X_AA_, X_AB_, collision_request_, result);
        collision_request_.updateGuess(result);
      } else {
        coal::collide(models_.a.get(), X_AA_, models_.b.get(), X_AB_, collision_request_, result);
      }
      return result.isCollision();
    });
  }

  Outcome<Separation> distance(const Pose& X_AB) override {
    return at(X_AB, [&]() -> Outcome<Separation> {
      coal::DistanceResult result;
      if (is_tuned_) {
        distance_(X_AA_, X_AB_, distance_request_, result);
        distance_request_.updateGuess(result);
      } else {
        coal::distance(models_.a.get(), X_AA_, models_.b.get(), X_AB_, distance_request_, result);
      }
      if (!std::isfinite(result.min_distance)) return fail(Status::non_finite, "the distance is not finite");
      if (result.min_distance == std::numeric_limits<Scalar>::max())
        return fail(Status::failed, "no distance was found");
      Separation separation;
      if (result.min_distance <= 0.0) return separation;
      separation.distance = result.min_distance;
      separation.witness_a = result.nearest_points[0].template cast<double>();
      separation.witness_b = result.nearest_points[1].template cast<double>();
      separation.has_witnesses = separation.witness_a.allFinite() && separation.witness_b.allFinite();
      return separation;
    });
  }

 private:
  const bool is_tuned_;
  coal::CollisionRequest collision_request_;
  coal::DistanceRequest distance_request_;
  const coal::ComputeCollision collide_;
  const coal::ComputeDistance distance_;
};

class ContactsQuery final : public CoalQuery {
 public:
  ContactsQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : CoalQuery(a, b), center_b_(b.center()), wrench_(settings) {
    request_.num_max_contacts = static_cast<std::size_t>(settings.number(k_max_contacts));
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    return at(X_AB, [&]() -> Outcome<Response> {
      coal::CollisionResult result;
      coal::collide(models_.a.get(), X_AA_, models_.b.get(), X_AB_, request_, result);
      if (result.numContacts() >= request_.num_max_contacts) {
        return too_many_contacts(request_.num_max_contacts);
      }
      wrench_.reset(X_AB * center_b_);
      for (std::size_t i = 0; i < result.numContacts(); ++i) {
        const coal::Contact& contact = result.getContact(i);
        // Coal's normal points from the first body to the second: A to B.
        wrench_.add(contact.pos.template cast<double>(), contact.normal.template cast<double>(),
                    -static_cast<double>(contact.penetration_depth));
      }
      return response_of(wrench_);
    });
  }

  /// Coal stops its search once it has so many.
  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override {
    if (most == 0) return Contacts{};
    return at(X_AB, [&]() -> Outcome<Contacts> {
      coal::CollisionRequest request = request_;
      request.num_max_contacts = most;
      coal::CollisionResult result;
      coal::collide(models_.a.get(), X_AA_, models_.b.get(), X_AB_, request, result);
      Contacts found;
      for (std::size_t i = 0; i < result.numContacts(); ++i) {
        const coal::Contact& contact = result.getContact(i);
        found.list.push_back({contact.pos.template cast<double>(), contact.normal.template cast<double>(),
                              -static_cast<double>(contact.penetration_depth)});
      }
      return found;
    });
  }

 private:
  const Eigen::Vector3d center_b_;
  ContactWrench wrench_;
  coal::CollisionRequest request_;
};

std::string version() {
  return fmt::format("{} {}", COAL_VERSION, sizeof(Scalar) == sizeof(double) ? "double" : "float");
}

}  // namespace

std::unique_ptr<Algorithm> make_coal_obbrss_algorithm() {
  return make_algorithm<ObbrssQuery>(
      {.name = "coal-obbrss",
       .version = version(),
       .summary = "Coal, tree of oriented boxes with rectangle-swept spheres",
       .answers = {.collide = true, .distance = true},
       .limits = {.surfaces_only = {.collide = true}},
       .parameters = {Parameter::choice(k_profile, "default: Coal's own requests; tuned: its developers' advice",
                                        "default", {"default", "tuned"})}});
}

std::unique_ptr<Algorithm> make_coal_contacts_algorithm() {
  return make_algorithm<ContactsQuery>(
      {.name = "coal-contacts",
       .version = version(),
       .summary = "Coal's contacts of triangle pairs as a penalty wrench",
       .answers = {.respond = true, .contacts = true},
       .law = ResponseLaw::contacts,
       .depth = ContactDepth::triangles,
       .limits = {.surfaces_only = {.collide = true, .respond = true}, .own_direction = true},
       .parameters = {ContactWrench::combine_parameter(), max_contacts_parameter("1000000", 1e9)}});
}

void register_coal_algorithms(Registry& registry) {
  registry.add(make_coal_obbrss_algorithm());
  registry.add(make_coal_contacts_algorithm());
}

}  // namespace sixdof
