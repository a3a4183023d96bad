#include <sixdof/algorithm/fcl/fcl.h>

#include <fcl/config.h>

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include <fcl/math/bv/AABB.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/math/bv/RSS.h>
#include <fcl/math/bv/kIOS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>

#include <sixdof/algorithm/fcl/fcl_mesh.h>

namespace sixdof {
namespace {

constexpr const char* k_relative_error = "relative_error";
constexpr const char* k_max_contacts = "max_contacts";

/// The trees of both bodies. Equal meshes share one.
template <class BV>
class FclQuery : public LibraryQuery {
 public:
  Footprint footprint() const override {
    Footprint sum;
    double nodes = 0.0;
    double triangles = 0.0;
    models_.for_each([&](const fcl::BVHModel<BV>& model) {
      nodes += model.getNumBVs();
      triangles += model.num_tris;
      // FCL's own memUsage() returns a status instead of a size.
      sum.bytes += sizeof(model) + static_cast<std::size_t>(model.getNumBVs()) * sizeof(fcl::BVNode<BV>) +
                   static_cast<std::size_t>(model.num_tris) * (sizeof(fcl::Triangle) + sizeof(unsigned)) +
                   static_cast<std::size_t>(model.num_vertices) * sizeof(fcl::Vector3d);
    });
    sum.counts = {{"nodes", nodes}, {"triangles", triangles}};
    return sum;
  }

 protected:
  FclQuery(const Mesh& a, const Mesh& b) : models_(ShapePair<fcl::BVHModel<BV>>::of(a, b, build_fcl_model<BV>)) {}

  /// Whether any two triangles intersect. FCL stops at the first pair.
  Outcome<bool> any_contact(const Pose& X_AB) {
    return guarded(X_AB, [&]() -> Outcome<bool> {
      X_AB_ = to_fcl(X_AB);
      fcl::CollisionResultd result;
      fcl::collide<double>(models_.a.get(), X_AA_, models_.b.get(), X_AB_, first_contact_, result);
      return result.isCollision();
    });
  }

  const fcl::CollisionRequestd first_contact_{1, false};  ///< One contact, without its points.
  const ShapePair<fcl::BVHModel<BV>> models_;
  const fcl::Transform3d X_AA_ = fcl::Transform3d::Identity();
  fcl::Transform3d X_AB_ = fcl::Transform3d::Identity();
};

template <class BV>
class FclCollideQuery final : public FclQuery<BV> {
 public:
  FclCollideQuery(const Mesh& a, const Mesh& b, const Settings& /*settings*/) : FclQuery<BV>(a, b) {}
  Outcome<bool> collide(const Pose& X_AB) override { return this->any_contact(X_AB); }
};

/// FCL's traversal for distances in trees of BV.
template <class BV>
struct DistanceNode;
template <>
struct DistanceNode<fcl::OBBRSSd> {
  using type = fcl::detail::MeshDistanceTraversalNodeOBBRSSd;
};
template <>
struct DistanceNode<fcl::RSSd> {
  using type = fcl::detail::MeshDistanceTraversalNodeRSSd;
};
template <>
struct DistanceNode<fcl::kIOSd> {
  using type = fcl::detail::MeshDistanceTraversalNodekIOSd;
};

template <class BV>
class FclDistanceQuery final : public FclQuery<BV> {
  using Base = FclQuery<BV>;
  using Base::fail, Base::guarded, Base::models_, Base::X_AA_, Base::X_AB_;

 public:
  FclDistanceQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : Base(a, b), relative_error_(settings.number(k_relative_error)) {}

  Outcome<bool> collide(const Pose& X_AB) override {
    if constexpr (std::is_same_v<BV, fcl::RSSd>) {
      return Status::unsupported;
    } else {
      return this->any_contact(X_AB);
    }
  }

  Outcome<Separation> distance(const Pose& X_AB) override {
    return guarded(X_AB, [&] {
      X_AB_ = to_fcl(X_AB);
      fcl::DistanceResultd result;
      if (relative_error_ == 0.0) {
        fcl::distance<double>(models_.a.get(), X_AA_, models_.b.get(), X_AB_, nearest_points_, result);
      } else {
        approximate_distance(result);
      }
      return answer(result);
    });
  }

 private:
  /// FCL 0.7 ignores the error bounds of a request, so they are set on the traversal node here. FCL skips a pair of
  /// volumes if BOTH bounds hold; with an infinite absolute bound the relative one decides.
  void approximate_distance(fcl::DistanceResultd& result) {
    typename DistanceNode<BV>::type node;
    fcl::detail::initialize(node, *models_.a, X_AA_, *models_.b, X_AB_, nearest_points_, result);
    node.rel_err = relative_error_;
    node.abs_err = std::numeric_limits<double>::infinity();
    fcl::detail::distance<double>(&node);
  }

  Outcome<Separation> answer(const fcl::DistanceResultd& result) {
    if (!std::isfinite(result.min_distance)) return fail(Status::non_finite, "the distance is not finite");
    if (result.min_distance == std::numeric_limits<double>::max()) return fail(Status::failed, "no distance was found");
    Separation separation;
    // Where surfaces intersect, FCL returns a value that is not positive.
    if (result.min_distance <= 0.0) return separation;
    separation.distance = result.min_distance;
    separation.has_witnesses = true;
    // A's frame is FCL's world.
    separation.witness_a = result.nearest_points[0];
    separation.witness_b = result.nearest_points[1];
    if (!separation.witness_a.allFinite() || !separation.witness_b.allFinite()) {
      return fail(Status::non_finite, "a nearest point is not finite");
    }
    return separation;
  }

  const double relative_error_;
  const fcl::DistanceRequestd nearest_points_{true};
};

class ContactsQuery final : public FclQuery<fcl::OBBRSSd> {
 public:
  ContactsQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : FclQuery(a, b),
        center_b_(b.center()),
        wrench_(settings),
        request_(static_cast<std::size_t>(settings.number(k_max_contacts)), true) {}

  Outcome<Response> respond(const Pose& X_AB) override {
    return guarded(X_AB, [&]() -> Outcome<Response> {
      X_AB_ = to_fcl(X_AB);
      fcl::CollisionResultd result;
      fcl::collide<double>(models_.a.get(), X_AA_, models_.b.get(), X_AB_, request_, result);
      if (result.numContacts() >= request_.num_max_contacts) {
        return too_many_contacts(request_.num_max_contacts);
      }
      wrench_.reset(X_AB * center_b_);
      for (std::size_t i = 0; i < result.numContacts(); ++i) {
        const fcl::Contactd& contact = result.getContact(i);
        // FCL's normal points from the first body to the second: A to B.
        wrench_.add(contact.pos, contact.normal, contact.penetration_depth);
      }
      return response_of(wrench_);
    });
  }

  /// FCL stops its search once it has so many.
  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override {
    if (most == 0) return Contacts{};
    return guarded(X_AB, [&]() -> Outcome<Contacts> {
      X_AB_ = to_fcl(X_AB);
      fcl::CollisionResultd result;
      fcl::collide<double>(models_.a.get(), X_AA_, models_.b.get(), X_AB_, fcl::CollisionRequestd(most, true), result);
      Contacts found;
      for (std::size_t i = 0; i < result.numContacts(); ++i) {
        const fcl::Contactd& contact = result.getContact(i);
        found.list.push_back({contact.pos, contact.normal, contact.penetration_depth});
      }
      return found;
    });
  }

 private:
  const Eigen::Vector3d center_b_;
  ContactWrench wrench_;
  const fcl::CollisionRequestd request_;
};

Traits traits(std::string name, std::string summary, QuerySet answers) {
  return {.name = std::move(name),
          .version = FCL_VERSION,
          .summary = std::move(summary),
          .answers = answers,
          .limits = {.surfaces_only = {.collide = true}},
          .parameters = {Parameter::number(k_relative_error,
                                           "a distance may be too large by this fraction of the true one; 0 is exact",
                                           "1", "0", 0.0, 1.0)
                             .swept({"1", "0.1", "0.01", "0"})}};
}

}  // namespace

std::unique_ptr<Algorithm> make_fcl_obbrss_algorithm() {
  return make_algorithm<FclDistanceQuery<fcl::OBBRSSd>>(traits(
      "fcl-obbrss", "FCL, tree of oriented boxes with rectangle-swept spheres", {.collide = true, .distance = true}));
}

std::unique_ptr<Algorithm> make_fcl_rss_algorithm() {
  return make_algorithm<FclDistanceQuery<fcl::RSSd>>(
      traits("fcl-rss", "FCL, tree of rectangle-swept spheres as in PQP", {.distance = true}));
}

std::unique_ptr<Algorithm> make_fcl_kios_algorithm() {
  return make_algorithm<FclDistanceQuery<fcl::kIOSd>>(
      traits("fcl-kios", "FCL, tree of intersections of spheres with an oriented box (kIOS)",
             {.collide = true, .distance = true}));
}

std::unique_ptr<Algorithm> make_fcl_obb_algorithm() {
  return make_algorithm<FclCollideQuery<fcl::OBBd>>({.name = "fcl-obb",
                                                     .version = FCL_VERSION,
                                                     .summary = "FCL, tree of oriented boxes",
                                                     .answers = {.collide = true},
                                                     .limits = {.surfaces_only = {.collide = true}}});
}

std::unique_ptr<Algorithm> make_fcl_aabb_algorithm() {
  return make_algorithm<FclCollideQuery<fcl::AABBd>>(
      {.name = "fcl-aabb",
       .version = FCL_VERSION,
       .summary = "FCL, tree of axis-aligned boxes; every query copies and refits the models",
       .answers = {.collide = true},
       .limits = {.surfaces_only = {.collide = true}}});
}

std::unique_ptr<Algorithm> make_fcl_contacts_algorithm() {
  return make_algorithm<ContactsQuery>(
      {.name = "fcl-contacts",
       .version = FCL_VERSION,
       .summary = "FCL's contacts of triangle pairs as a penalty wrench",
       .answers = {.respond = true, .contacts = true},
       .law = ResponseLaw::contacts,
       .depth = ContactDepth::triangles,
       .limits = {.surfaces_only = {.collide = true, .respond = true}, .own_direction = true},
       .parameters = {ContactWrench::combine_parameter(), max_contacts_parameter("1000000", 1e9)}});
}

std::string fcl_build() {
  const std::string package = SIXDOF_FCL_PACKAGE;
  return fmt::format("{}, FCL_HAVE_SSE {}, EIGEN_MAX_ALIGN_BYTES {}", package.empty() ? "FCL " FCL_VERSION : package,
                     FCL_HAVE_SSE, EIGEN_MAX_ALIGN_BYTES);
}

void register_fcl_algorithms(Registry& registry) {
  registry.add(make_fcl_obbrss_algorithm());
  registry.add(make_fcl_rss_algorithm());
  registry.add(make_fcl_kios_algorithm());
  registry.add(make_fcl_obb_algorithm());
  registry.add(make_fcl_aabb_algorithm());
  registry.add(make_fcl_contacts_algorithm());
  registry.add(make_fcl_cast_algorithm());
}

}  // namespace sixdof
