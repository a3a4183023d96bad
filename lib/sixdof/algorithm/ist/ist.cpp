#include <sixdof/algorithm/ist/ist.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/algorithm/ist/packing.h>
#include <sixdof/algorithm/ist/traversal.h>

namespace sixdof {
namespace ist {
namespace {

std::vector<Parameter> parameters() {
  return {
      Parameter::count("spheres", "spheres per body, at most", "10000", 1, 5e6)
          .swept({"300", "1000", "3000", "10000", "30000", "100000"}),
      Parameter::number("fill", "stop packing at this fraction of the solid's volume", "1", "1", 0.01, 1),
      Parameter::number("smallest_radius", "smallest radius of a sphere", "diagonal", "0.0001", 1e-6, 0.5),
      Parameter::choice("force",
                        "volume: each pair's force is its overlap volume; gradient: minus the gradient of that volume; "
                        "steepest_descent: the total volume, in the direction of the summed gradients",
                        "volume", {"volume", "gradient", "steepest_descent"}),
      Parameter::choice("correct_fill",
                        "on: divide volume and force by both fill rates; cells: weight each sphere with the part of "
                        "the solid that is nearest to it",
                        "off", {"off", "on", "cells"}),
      Parameter::count("budget", "sphere tests per response, beyond which the rest is estimated; 0: no limit", "0", 0,
                       1e9),
      Parameter::number("stiffness", "force per volume (force=volume, steepest_descent) or per area (force=gradient)",
                        "1", "1", 1e-12, 1e12),
      Parameter::count("seed", "of the packing's start points", "1", 0, 1e9),
  };
}

class IstQuery final : public Query {
 public:
  /// Equal meshes share one tree.
  IstQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : a_(std::make_shared<const InnerSphereTree>(build_inner_sphere_tree(a, settings))),
        b_(a.hash() == b.hash() ? a_ : std::make_shared<const InnerSphereTree>(build_inner_sphere_tree(b, settings))),
        center_b_(b.center()),
        law_(settings.choice("force") == "volume" ? PairForce::volume : PairForce::gradient),
        steepest_descent_(settings.choice("force") == "steepest_descent"),
        budget_(static_cast<std::uint64_t>(settings.number("budget"))),
        fill_correction_(settings.choice("correct_fill") == "on" ? 1.0 / (a_->fill * b_->fill) : 1.0),
        stiffness_(settings.number("stiffness")) {}

  Outcome<bool> collide(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return bad_pose();
    const SphereContact contact = overlaps(a_->tree, b_->tree, X_AB, scratch_);
    count_ = contact.count;
    return contact.any;
  }

  Outcome<Separation> distance(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return bad_pose();
    const SphereSeparation gap = separation(a_->tree, b_->tree, X_AB);
    count_ = gap.count;
    const Sphere& in_a = a_->tree.leaves[static_cast<std::size_t>(gap.leaf_a)];
    const Sphere& in_b = b_->tree.leaves[static_cast<std::size_t>(gap.leaf_b)];
    Separation result;
    result.distance = std::max(0.0, gap.distance);
    const Eigen::Vector3d center_b = X_AB * in_b.center;
    const Eigen::Vector3d offset = center_b - in_a.center;
    if (const double d = offset.norm(); d > 0.0 && gap.distance >= 0.0) {
      result.has_witnesses = true;
      result.witness_a = in_a.center + offset * (in_a.radius / d);
      result.witness_b = center_b - offset * (in_b.radius / d);
    }
    return result;
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return bad_pose();
    const Eigen::Vector3d reference = X_AB * center_b_;
    const PenetrationSum sum = budget_ == 0
                                   ? penetration(a_->tree, b_->tree, X_AB, law_, reference, scratch_)
                                   : penetration_within_budget(a_->tree, b_->tree, X_AB, law_, reference, budget_);
    count_ = sum.count;
    Response response;
    response.volume = fill_correction_ * sum.volume;
    response.penalty = response.volume;
    const Wrench wrench = steepest_descent_ ? steepest_descent(sum) : Wrench{sum.force, sum.moment};
    response.force = fill_correction_ * stiffness_ * wrench.force;
    response.torque = fill_correction_ * stiffness_ * wrench.moment;
    response.reference = reference;
    if (!response.force.allFinite() || !response.torque.allFinite() || !std::isfinite(response.volume)) {
      return fail(Status::non_finite, "force, torque or volume is not finite");
    }
    return response;
  }

  Footprint footprint() const override {
    const bool shared = a_ == b_;
    return {a_->tree.bytes() + (shared ? 0 : b_->tree.bytes()),
            {{"spheres_a", static_cast<double>(a_->tree.leaves.size())},
             {"spheres_b", static_cast<double>(b_->tree.leaves.size())},
             {"fill_a", a_->fill},
             {"fill_b", b_->fill}}};
  }

  /// Tests are of pairs of balls, inner nodes and empty slots included; the total is of pairs of packed spheres.
  std::vector<Work> work() const override {
    const auto spheres = [](const InnerSphereTree& tree) { return static_cast<double>(tree.tree.leaves.size()); };
    return {{"sphere_pairs", static_cast<double>(count_.sphere_tests), spheres(*a_) * spheres(*b_)}};
  }

 private:
  Status bad_pose() { return fail(Status::non_finite, "the pose is not finite"); }

  std::shared_ptr<const InnerSphereTree> a_, b_;
  Eigen::Vector3d center_b_;
  PairForce law_;
  bool steepest_descent_;
  std::uint64_t budget_;
  double fill_correction_;
  double stiffness_;
  TraversalScratch scratch_;
  TraversalCount count_;  ///< Of the last query.
};

}  // namespace

InnerSphereTree build_inner_sphere_tree(const Mesh& mesh, const Settings& settings) {
  Packing packing = cached_packing(mesh, {.spheres = static_cast<std::size_t>(settings.number("spheres")),
                                          .fill = settings.number("fill"),
                                          .smallest_radius = settings.number("smallest_radius"),
                                          .seed = static_cast<std::uint64_t>(settings.number("seed"))});
  InnerSphereTree result{build_sphere_tree(std::move(packing.spheres)), packing.fill};
  if (settings.choice("correct_fill") == "cells") {
    set_weights(result.tree, cached_cell_weights(mesh, result.tree.leaves));
  }
  return result;
}

}  // namespace ist

std::unique_ptr<Algorithm> make_ist_algorithm() {
  return make_algorithm<ist::IstQuery>(
      {.name = "ist",
       .version = SIXDOF_VERSION,
       .summary = "inner sphere trees (Weller and Zachmann 2009): overlap volume of packed spheres",
       .answers = {.collide = true, .distance = true, .respond = true},
       .law = ResponseLaw::volume,
       .parameters = ist::parameters()});
}

}  // namespace sixdof
