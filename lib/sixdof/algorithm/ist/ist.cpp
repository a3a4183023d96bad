#include <sixdof/algorithm/ist/ist.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/algorithm/ist/coverage.h>
#include <sixdof/algorithm/ist/normal_cone.h>
#include <sixdof/algorithm/ist/packing.h>
#include <sixdof/algorithm/ist/traversal.h>

namespace sixdof {
namespace ist {
namespace {

/// What both algorithms have.
std::vector<Parameter> packing_parameters() {
  const std::vector<std::string> sweep{"300", "1000", "3000", "10000", "30000", "100000"};
  return {
      Parameter::count("spheres", "spheres of body A, at most", "10000", 1, 5e6).swept(sweep),
      Parameter::count("spheres_b", "spheres of body B, at most; 0: as `spheres`", "0", 0, 5e6).swept(sweep),
      Parameter::number("fill", "stop packing at this fraction of the solid's volume", "1", "1", 0.01, 1),
      Parameter::number("smallest_radius", "smallest radius of a sphere", "diagonal", "0.0001", 1e-6, 0.5),
      Parameter::count("budget", "sphere tests per response, beyond which the rest is estimated; 0: no limit", "0", 0,
                       1e9),
      Parameter::count("seed", "of the packing's start points", "1", 0, 1e9),
  };
}

std::vector<Parameter> ist_parameters() {
  std::vector<Parameter> parameters = packing_parameters();
  parameters.push_back(
      Parameter::choice("force",
                        "cones: each pair's force is its overlap volume, along the axes of the spheres' normal cones; "
                        "volume: the same along the line of centres; gradient: minus the gradient of that volume",
                        "cones", {"cones", "volume", "gradient"}));
  parameters.push_back(Parameter::choice("correct_fill",
                                         "on: divide volume and force by both fill rates; cells: weight each sphere "
                                         "with the part of the solid that is nearest to it",
                                         "off", {"off", "on", "cells"}));
  parameters.push_back(Parameter::number(
      "stiffness", "force per volume (force=cones, volume) or per area (force=gradient)", "1", "1", 1e-12, 1e12));
  return parameters;
}

std::vector<Parameter> descent_parameters() {
  std::vector<Parameter> parameters = packing_parameters();
  parameters.push_back(Parameter::number("stiffness", "force per volume", "1", "1", 1e-12, 1e12));
  return parameters;
}

/// How a response follows from the overlaps of spheres.
struct ForceLaw {
  PairForce pair;
  bool steepest_descent;  ///< The total volume in the direction of the summed pairs' forces.
  bool by_fill_rates;     ///< Volume and force are divided by both fill rates.
  bool by_cells;          ///< Each sphere is weighted with its cell.
};

ForceLaw ist_law(const Settings& settings) {
  const std::string& force = settings.choice("force");
  const std::string& correction = settings.choice("correct_fill");
  return {.pair = force == "cones"    ? PairForce::cones
                  : force == "volume" ? PairForce::volume
                                      : PairForce::gradient,
          .steepest_descent = false,
          .by_fill_rates = correction == "on",
          .by_cells = correction == "cells"};
}

constexpr ForceLaw k_descent{
    .pair = PairForce::gradient, .steepest_descent = true, .by_fill_rates = false, .by_cells = true};

InnerSphereTree build_tree(const Mesh& mesh, const Settings& settings, double spheres, const ForceLaw& law) {
  Packing packing = cached_packing(mesh, {.spheres = static_cast<std::size_t>(spheres),
                                          .fill = settings.number("fill"),
                                          .smallest_radius = settings.number("smallest_radius"),
                                          .seed = static_cast<std::uint64_t>(settings.number("seed"))});
  InnerSphereTree result{build_sphere_tree(std::move(packing.spheres)), packing.fill};
  SphereTree& tree = result.tree;
  if (law.by_cells) set_weights(tree, cached_cell_weights(mesh, tree.leaves));
  if (law.pair == PairForce::cones) {
    for (const NormalCone& cone : cached_normal_cones(mesh, tree.leaves)) tree.axes.push_back(cone.axis);
  }
  return result;
}

double spheres_of_b(const Settings& settings) {
  const double own = settings.number("spheres_b");
  return own > 0.0 ? own : settings.number("spheres");
}

class SphereTreeQuery : public Query {
 public:
  /// Equal meshes with equally many spheres share one tree.
  SphereTreeQuery(const Mesh& a, const Mesh& b, const Settings& settings, const ForceLaw& law)
      : mesh_a_(&a),
        mesh_b_(&b),
        a_(std::make_shared<const InnerSphereTree>(build_tree(a, settings, settings.number("spheres"), law))),
        b_(a.hash() == b.hash() && spheres_of_b(settings) == settings.number("spheres")
               ? a_
               : std::make_shared<const InnerSphereTree>(build_tree(b, settings, spheres_of_b(settings), law))),
        center_b_(b.center()),
        law_(law),
        budget_(static_cast<std::uint64_t>(settings.number("budget"))),
        fill_correction_(law.by_fill_rates ? 1.0 / (a_->fill * b_->fill) : 1.0),
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
                                   ? penetration(a_->tree, b_->tree, X_AB, law_.pair, reference, scratch_)
                                   : penetration_within_budget(a_->tree, b_->tree, X_AB, law_.pair, reference, budget_);
    count_ = sum.count;
    Response response;
    response.volume = fill_correction_ * sum.volume;
    response.penalty = response.volume;
    const Wrench wrench = law_.steepest_descent ? steepest_descent(sum) : Wrench{sum.force, sum.moment};
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
             {"fill_b", b_->fill},
             {"resolution", largest_gap(*mesh_a_, a_->tree.leaves) + largest_gap(*mesh_b_, b_->tree.leaves)}}};
  }

  /// Tests are of pairs of balls, inner nodes and empty slots included; the total is of pairs of packed spheres.
  std::vector<Work> work() const override {
    const auto spheres = [](const InnerSphereTree& tree) { return static_cast<double>(tree.tree.leaves.size()); };
    return {{"sphere_pairs", static_cast<double>(count_.sphere_tests), spheres(*a_) * spheres(*b_)}};
  }

 private:
  Status bad_pose() { return fail(Status::non_finite, "the pose is not finite"); }

  const Mesh *mesh_a_, *mesh_b_;
  std::shared_ptr<const InnerSphereTree> a_, b_;
  Eigen::Vector3d center_b_;
  ForceLaw law_;
  std::uint64_t budget_;
  double fill_correction_;
  double stiffness_;
  TraversalScratch scratch_;
  TraversalCount count_;  ///< Of the last query.
};

class IstQuery final : public SphereTreeQuery {
 public:
  IstQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : SphereTreeQuery(a, b, settings, ist_law(settings)) {}
};

class IstDescentQuery final : public SphereTreeQuery {
 public:
  IstDescentQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : SphereTreeQuery(a, b, settings, k_descent) {}
};

}  // namespace

InnerSphereTree build_inner_sphere_tree(const Mesh& mesh, const Settings& settings) {
  return build_tree(mesh, settings, settings.number("spheres"), ist_law(settings));
}

}  // namespace ist

std::unique_ptr<Algorithm> make_ist_algorithm() {
  return make_algorithm<ist::IstQuery>(
      {.name = "ist",
       .version = SIXDOF_VERSION,
       .summary = "inner sphere trees (Weller and Zachmann 2009): overlap volume of packed spheres along normal cones",
       .answers = {.collide = true, .distance = true, .respond = true},
       .law = ResponseLaw::volume,
       .approximates = true,
       .limits = {.distance_of_bodies = true, .own_direction = true},
       .parameters = ist::ist_parameters()});
}

std::unique_ptr<Algorithm> make_ist_descent_algorithm() {
  return make_algorithm<ist::IstDescentQuery>(
      {.name = "ist-descent",
       .version = SIXDOF_VERSION,
       .summary = "inner sphere trees: overlap volume of weighted spheres, in the direction of its steepest descent",
       .answers = {.collide = true, .distance = true, .respond = true},
       .law = ResponseLaw::volume,
       .approximates = true,
       .limits = {.distance_of_bodies = true, .own_direction = true},
       .parameters = ist::descent_parameters()});
}

}  // namespace sixdof
