#include <sixdof/algorithm/fcl/fcl.h>

#include <fcl/config.h>

#include <cmath>
#include <exception>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include <fcl/math/bv/OBBRSS.h>
#include <fcl/math/bv/RSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>

#include <sixdof/algorithm/fcl/contacts.h>
#include <sixdof/algorithm/fcl/model.h>
#include <sixdof/base/error.h>

namespace sixdof {
namespace {

using fcl_backend::build_model;
using fcl_backend::bytes_of;
using fcl_backend::Model;

constexpr const char* k_relative_error = "relative_error";

template <class BV>
class FclQuery final : public Query {
 public:
  /// Equal meshes share one tree.
  FclQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : a_(build_model<BV>(a)),
        b_(a.hash() == b.hash() ? a_ : build_model<BV>(b)),
        relative_error_(settings.number(k_relative_error)) {
    first_contact_.num_max_contacts = 1;
    first_contact_.enable_contact = false;
    nearest_points_.enable_nearest_points = true;
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if constexpr (!std::is_same_v<BV, fcl::OBBRSSd>) {
      return Status::unsupported;
    } else {
      if (!set_pose(X_AB)) return bad_pose();
      try {
        fcl::CollisionResultd result;
        fcl::collide<double>(a_.get(), X_AA_, b_.get(), X_AB_, first_contact_, result);
        return result.isCollision();
      } catch (const std::exception& e) {
        return fail(Status::failed, e.what());
      }
    }
  }

  Outcome<Separation> distance(const Pose& X_AB) override {
    if (!set_pose(X_AB)) return bad_pose();
    try {
      fcl::DistanceResultd result;
      if (relative_error_ == 0.0) {
        fcl::distance<double>(a_.get(), X_AA_, b_.get(), X_AB_, nearest_points_, result);
      } else {
        approximate_distance(result);
      }
      return answer(result);
    } catch (const std::exception& e) {
      return fail(Status::failed, e.what());
    }
  }

  Footprint footprint() const override {
    Footprint sum;
    double nodes = 0.0;
    double triangles = 0.0;
    const auto add = [&](const Model<BV>& model) {
      sum.bytes += bytes_of(model);
      nodes += model.getNumBVs();
      triangles += model.num_tris;
    };
    add(*a_);
    if (b_ != a_) add(*b_);
    sum.counts = {{"nodes", nodes}, {"triangles", triangles}};
    return sum;
  }

 private:
  /// False if the pose is not finite: FCL would find no two volumes apart and expand the whole tree.
  bool set_pose(const Pose& X_AB) {
    if (!is_finite(X_AB)) return false;
    X_AB_.linear() = X_AB.R;
    X_AB_.translation() = X_AB.t;
    return true;
  }

  Status bad_pose() { return fail(Status::failed, "the pose is not finite"); }

  /// FCL 0.7 ignores the error bounds of a request, so they are set on the traversal node here. FCL skips a pair of
  /// volumes if BOTH bounds hold; with an infinite absolute bound the relative one decides.
  void approximate_distance(fcl::DistanceResultd& result) {
    using Node = std::conditional_t<std::is_same_v<BV, fcl::OBBRSSd>, fcl::detail::MeshDistanceTraversalNodeOBBRSSd,
                                    fcl::detail::MeshDistanceTraversalNodeRSSd>;
    Node node;
    fcl::detail::initialize(node, *a_, X_AA_, *b_, X_AB_, nearest_points_, result);
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

  const std::shared_ptr<const Model<BV>> a_;
  const std::shared_ptr<const Model<BV>> b_;
  const double relative_error_;
  fcl::CollisionRequestd first_contact_;
  fcl::DistanceRequestd nearest_points_;
  const fcl::Transform3d X_AA_ = fcl::Transform3d::Identity();
  fcl::Transform3d X_AB_ = fcl::Transform3d::Identity();
};

Traits traits(std::string name, std::string summary, QuerySet answers) {
  return {.name = std::move(name),
          .version = FCL_VERSION,
          .summary = std::move(summary),
          .answers = answers,
          .parameters = {{.name = k_relative_error,
                          .meaning = "a distance may be too large by this fraction of the true one; 0 is exact",
                          .unit = "1",
                          .default_value = "0",
                          .low = 0.0,
                          .high = 1.0}}};
}

}  // namespace

std::unique_ptr<Algorithm> make_fcl_obbrss_algorithm() {
  return make_algorithm<FclQuery<fcl::OBBRSSd>>(traits(
      "fcl-obbrss", "FCL, tree of oriented boxes with rectangle-swept spheres", {.collide = true, .distance = true}));
}

std::unique_ptr<Algorithm> make_fcl_rss_algorithm() {
  return make_algorithm<FclQuery<fcl::RSSd>>(
      traits("fcl-rss", "FCL, tree of rectangle-swept spheres as in PQP", {.distance = true}));
}

void register_fcl_algorithms(Registry& registry) {
  registry.add(make_fcl_obbrss_algorithm());
  registry.add(make_fcl_rss_algorithm());
  registry.add(make_fcl_contacts_algorithm());
}

}  // namespace sixdof
