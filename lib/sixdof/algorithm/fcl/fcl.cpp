#include <sixdof/algorithm/fcl/fcl.h>

#include <fcl/config.h>

#include <cmath>
#include <exception>
#include <limits>
#include <type_traits>
#include <vector>

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
  FclQuery(std::shared_ptr<const Model<BV>> a, std::shared_ptr<const Model<BV>> b, double relative_error)
      : a_(std::move(a)), b_(std::move(b)), relative_error_(relative_error) {
    first_contact_.num_max_contacts = 1;
    first_contact_.enable_contact = false;
    nearest_points_.enable_nearest_points = true;
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if constexpr (!std::is_same_v<BV, fcl::OBBRSSd>) {
      return Status::unsupported;
    } else {
      if (!place(X_AB)) return bad_pose();
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
    if (!place(X_AB)) return bad_pose();
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
  /// False if the pose is not finite: FCL would find no pair of volumes apart and visit all of them.
  bool place(const Pose& X_AB) {
    if (!X_AB.R.allFinite() || !X_AB.t.allFinite()) return false;
    X_AB_.linear() = X_AB.R;
    X_AB_.translation() = X_AB.t;
    return true;
  }

  Status bad_pose() { return fail(Status::failed, "the pose is not finite"); }

  /// FCL 0.7 takes error bounds in the request but never hands them to the traversal, so the traversal is run by hand.
  /// Its two bounds must BOTH hold for a node to be skipped; an infinite absolute one leaves the relative one alone.
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
    // FCL says "intersecting" with any value that is not positive.
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

template <class BV>
class FclAlgorithm final : public Algorithm {
 public:
  FclAlgorithm(std::string name, std::string summary, QuerySet answers)
      : traits_{.name = std::move(name),
                .version = FCL_VERSION,
                .summary = std::move(summary),
                .answers = answers,
                .law = ResponseLaw::none,
                .parameters = {{.name = k_relative_error,
                           .meaning = "a distance may be too large by this share of the true one; 0 is exact",
                           .unit = "1",
                           .standard = "0",
                           .low = 0.0,
                           .high = 1.0}}} {}

  const Traits& traits() const override { return traits_; }

  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
    const auto model_a = build_model<BV>(a);
    // Two copies of one body share one tree, as a program with many of them would.
    const auto model_b = a.hash() == b.hash() ? model_a : build_model<BV>(b);
    return std::make_unique<FclQuery<BV>>(model_a, model_b, settings.number(k_relative_error));
  }

 private:
  Traits traits_;
};

}  // namespace

std::unique_ptr<Algorithm> make_fcl_obbrss_algorithm() {
  return std::make_unique<FclAlgorithm<fcl::OBBRSSd>>("fcl-obbrss",
                                                      "FCL, tree of oriented boxes with rectangle-swept spheres",
                                                      QuerySet{.collide = true, .distance = true});
}

std::unique_ptr<Algorithm> make_fcl_rss_algorithm() {
  return std::make_unique<FclAlgorithm<fcl::RSSd>>("fcl-rss", "FCL, tree of rectangle-swept spheres as in PQP",
                                                   QuerySet{.distance = true});
}

void register_fcl_algorithms(Registry& registry) {
  registry.add(make_fcl_obbrss_algorithm());
  registry.add(make_fcl_rss_algorithm());
  registry.add(make_fcl_contacts_algorithm());
}

}  // namespace sixdof
