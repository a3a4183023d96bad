#include <sixdof/algorithm/ist/ist.h>

#include <algorithm>
#include <cmath>

#include <sixdof/algorithm/ist/cells.h>
#include <sixdof/algorithm/ist/descent.h>
#include <sixdof/algorithm/ist/packing.h>
#include <sixdof/algorithm/ist/traversal.h>

namespace sixdof {
namespace ist {
namespace {

std::vector<Parameter> parameters() {
  return {{.name = "spheres",
           .meaning = "spheres per object, at most",
           .unit = "1",
           .standard = "10000",
           .low = 1,
           .high = 5e6,
           .integer = true},
          {.name = "fill",
           .meaning = "stop packing at this share of the solid's volume",
           .unit = "1",
           .standard = "1",
           .low = 0.01,
           .high = 1},
          {.name = "smallest_radius",
           .meaning = "smallest sphere",
           .unit = "diagonal",
           .standard = "0.0001",
           .low = 1e-6,
           .high = 0.5},
          {.name = "force",
           .meaning = "pairs of spheres push with their overlap's volume, or minus its gradient; descent: all of the "
                      "volume along the sum of the gradients",
           .unit = "",
           .standard = "volume",
           .choices = {"volume", "gradient", "descent"}},
          {.name = "correct_fill",
           .meaning = "divide volume and force by both fill rates; cells: each sphere counts for the part of the solid "
                      "nearest to it",
           .unit = "",
           .standard = "off",
           .choices = {"off", "on", "cells"}},
          {.name = "budget",
           .meaning = "sphere tests per response, the rest is estimated; 0: no limit",
           .unit = "1",
           .standard = "0",
           .low = 0,
           .high = 1e9,
           .integer = true},
          {.name = "stiffness",
           .meaning = "force per volume (force=volume, descent) or per area (force=gradient)",
           .unit = "1",
           .standard = "1",
           .low = 1e-12,
           .high = 1e12},
          {.name = "seed",
           .meaning = "of the packing's starting points",
           .unit = "1",
           .standard = "1",
           .low = 0,
           .high = 1e9,
           .integer = true}};
}

class IstQuery final : public Query {
 public:
  IstQuery(std::shared_ptr<const InnerSphereTree> a, std::shared_ptr<const InnerSphereTree> b, const Mesh& mesh_b,
           const Settings& settings)
      : a_(std::move(a)),
        b_(std::move(b)),
        center_b_(mesh_b.center()),
        law_(settings.choice("force") == "volume" ? PairForce::volume : PairForce::gradient),
        descends_(settings.choice("force") == "descent"),
        budget_(static_cast<std::uint64_t>(settings.number("budget"))),
        gain_(settings.choice("correct_fill") == "on" ? 1.0 / (a_->fill * b_->fill) : 1.0),
        stiffness_(settings.number("stiffness")) {}

  Outcome<bool> collide(const Pose& X_AB) override {
    if (!finite(X_AB)) return bad_pose();
    const SphereContact contact = overlaps(a_->tree, b_->tree, X_AB, scratch_);
    count_ = contact.count;
    return contact.any;
  }

  Outcome<Separation> distance(const Pose& X_AB) override {
    if (!finite(X_AB)) return bad_pose();
    const SphereSeparation gap = separation(a_->tree, b_->tree, X_AB);
    count_ = gap.count;
    const Sphere& in_a = a_->tree.leaves[static_cast<std::size_t>(gap.leaf_a)];
    const Sphere& in_b = b_->tree.leaves[static_cast<std::size_t>(gap.leaf_b)];
    Separation result;
    result.distance = std::max(0.0, gap.distance);
    const Eigen::Vector3d center_b = X_AB * in_b.center;
    const Eigen::Vector3d across = center_b - in_a.center;
    if (const double d = across.norm(); d > 0.0 && gap.distance >= 0.0) {
      result.has_witnesses = true;
      result.witness_a = in_a.center + across * (in_a.radius / d);
      result.witness_b = center_b - across * (in_b.radius / d);
    }
    return result;
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (!finite(X_AB)) return bad_pose();
    const Eigen::Vector3d reference = X_AB * center_b_;
    const PenetrationSum sum = budget_ == 0 ? penetration(a_->tree, b_->tree, X_AB, law_, reference, scratch_)
                                            : penetration_within(a_->tree, b_->tree, X_AB, law_, reference, budget_);
    count_ = sum.count;
    Response response;
    response.volume = gain_ * sum.volume;
    response.penalty = response.volume;
    const PushSum push = descends_ ? steepest_descent(sum) : PushSum{sum.force, sum.moment};
    response.force = gain_ * stiffness_ * push.force;
    response.torque = gain_ * stiffness_ * push.moment;
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

  /// Visited are pairs of balls, those of inner nodes and empty lanes included; present are pairs of packed spheres.
  std::vector<Work> work() const override {
    const auto spheres = [](const InnerSphereTree& tree) { return static_cast<double>(tree.tree.leaves.size()); };
    return {{"sphere_pairs", static_cast<double>(count_.sphere_tests), spheres(*a_) * spheres(*b_)}};
  }

 private:
  static bool finite(const Pose& X) { return X.R.allFinite() && X.t.allFinite(); }
  Status bad_pose() { return fail(Status::non_finite, "the pose is not finite"); }

  std::shared_ptr<const InnerSphereTree> a_, b_;
  Eigen::Vector3d center_b_;
  PairForce law_;
  bool descends_;
  std::uint64_t budget_;
  double gain_;
  double stiffness_;
  TraversalScratch scratch_;
  TraversalCount count_;  ///< Of the last query.
};

class IstAlgorithm final : public Algorithm {
 public:
  const Traits& traits() const override { return traits_; }

  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
    const auto tree_a = std::make_shared<const InnerSphereTree>(build_inner_sphere_tree(a, settings));
    const auto tree_b =
        a.hash() == b.hash() ? tree_a : std::make_shared<const InnerSphereTree>(build_inner_sphere_tree(b, settings));
    return std::make_unique<IstQuery>(tree_a, tree_b, b, settings);
  }

 private:
  Traits traits_{.name = "ist",
                 .version = SIXDOF_VERSION,
                 .summary = "inner sphere trees (Weller and Zachmann 2009): overlap volume of packed spheres",
                 .answers = {.collide = true, .distance = true, .respond = true},
                 .law = ResponseLaw::volume,
                 .parameters = parameters()};
};

}  // namespace

InnerSphereTree build_inner_sphere_tree(const Mesh& mesh, const Settings& settings) {
  Packing packing = pack_spheres_cached(mesh, {.spheres = static_cast<std::size_t>(settings.number("spheres")),
                                               .fill = settings.number("fill"),
                                               .smallest_radius = settings.number("smallest_radius"),
                                               .seed = static_cast<std::uint64_t>(settings.number("seed"))});
  InnerSphereTree result{build_sphere_tree(std::move(packing.spheres)), packing.fill};
  if (settings.choice("correct_fill") == "cells") {
    set_shares(result.tree, cell_shares_cached(mesh, result.tree.leaves));
  }
  return result;
}

}  // namespace ist

std::unique_ptr<Algorithm> make_ist_algorithm() { return std::make_unique<ist::IstAlgorithm>(); }

}  // namespace sixdof
