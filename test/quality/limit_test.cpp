// The error of `exact` in scenario II is that of the tessellation alone: its answer is that of the tessellated solids,
// which converges to that of the round solids.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/measure/direction.h>
#include <sixdof/measure/magnitude.h>
#include <sixdof/scenario/evaluation.h>
#include <sixdof/scenario/solids.h>
#include "bench/common/all_algorithms.h"

namespace sixdof {
namespace {

constexpr double k_slice_error = 1e-6;  // relative: the midpoint rule of the slices is good to some 1e-7

std::unique_ptr<Scenario> orbit_of(int facets) {
  Settings shape = scenario_settings("II");
  shape.set("facets", std::to_string(facets));
  return make_scenario("II", shape);
}

Recording record_exact(const Scenario& scenario, std::size_t steps) {
  Registry registry;
  register_all_algorithms(registry);
  const Algorithm& exact = registry.find("exact");
  return record(scenario, *exact.prepare(scenario.a(), scenario.b(), exact.settings()), steps);
}

struct Error {
  double sigma, gamma_degrees;
};

Error error_against_round_solids(int facets) {
  const auto scenario = orbit_of(facets);
  std::map<std::string, double> measures;
  for (const auto& [name, value] : evaluate(*scenario, record_exact(*scenario, 60), IdealLaw::volume)) {
    measures[name] = value;
  }
  return {measures.at("sigma_F"), measures.at("gamma_F_deg")};
}

TEST(Limit, OfExactInScenarioTwoIsTheTessellation) {
  const Error at48 = error_against_round_solids(48);
  const Error at96 = error_against_round_solids(96);
  const Error at192 = error_against_round_solids(192);
  for (const auto& [coarse, fine] : {std::pair(at48, at96), std::pair(at96, at192)}) {
    EXPECT_GT(std::log2(coarse.sigma / fine.sigma), 3.0) << coarse.sigma << ' ' << fine.sigma;
    EXPECT_GT(std::log2(coarse.gamma_degrees / fine.gamma_degrees), 2.0) << coarse.gamma_degrees;
  }
  const Error finest = error_against_round_solids(1024);
  EXPECT_LE(finest.sigma, 1e-6);
  EXPECT_LE(finest.gamma_degrees, 1e-4);
}

/// Length and middle of the part of a segment inside a convex, counter-clockwise polygon.
struct Inside {
  double length = 0.0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
};

Inside clip(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::vector<Eigen::Vector2d>& window) {
  double enter = 0.0;
  double leave = 1.0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const Eigen::Vector2d edge = window[(i + 1) % window.size()] - window[i];
    const auto side = [&](const Eigen::Vector2d& p) {
      return edge.x() * (p.y() - window[i].y()) - edge.y() * (p.x() - window[i].x());
    };
    const double at_from = side(from);
    const double at_to = side(to);
    if (at_from < 0.0 && at_to < 0.0) return {};
    if (at_from < 0.0) enter = std::max(enter, at_from / (at_from - at_to));
    if (at_to < 0.0) leave = std::min(leave, at_from / (at_from - at_to));
  }
  if (enter >= leave) return {};
  return {(leave - enter) * (to - from).norm(), from + 0.5 * (enter + leave) * (to - from)};
}

/// -grad V of the faceted sphere in the faceted cylinder by horizontal slices, which are polygons: minus the integral
/// over z of the outward normals along the part of the sphere's outline inside the cylinder's. Torque about the
/// sphere's centre, along z.
class Slices {
 public:
  Slices(double sphere_vertex, double cylinder_vertex, int facets)
      : bands_(facets / 2),
        sphere_(sphere_vertex),
        unit_(polygon(1.0, facets, RoundParts::inscribed)),
        cylinder_(polygon(cylinder_vertex, facets, RoundParts::inscribed)) {}

  Eigen::Vector3d wrench(const Eigen::Vector2d& center) const {
    constexpr int k_slices = 80;  // per piece: the midpoint rule at kinks is then good to some 1e-7 of the force
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int band = 0; band < bands_ / 2; ++band) {  // the upper half; the lower one is its mirror image
      const double upper = std::numbers::pi * band / bands_;
      const double lower = std::numbers::pi * (band + 1) / bands_;
      const double height = sphere_ * (std::cos(upper) - std::cos(lower));
      const double least = sphere_ * std::sin(upper);
      const double growth = sphere_ * std::sin(lower) - least;
      if (center.norm() - least - growth > cylinder_.front().norm()) continue;
      // Outlines have parallel edges. Where two of them coincide, the slice's force jumps.
      std::vector<double> cuts{0.0, 1.0};
      for (std::size_t j = 0; j < unit_.size(); ++j) {
        const Eigen::Vector2d normal = (unit_[j] + unit_[(j + 1) % unit_.size()]).normalized();
        const double fraction =
            ((center.dot(normal) - cylinder_[j].dot(normal)) / unit_[j].dot(normal) - least) / growth;
        if (fraction > 0.0 && fraction < 1.0) cuts.push_back(fraction);
      }
      std::sort(cuts.begin(), cuts.end());
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double step = (cuts[i + 1] - cuts[i]) / k_slices;
        for (int k = 0; k < k_slices; ++k) {
          sum += 2.0 * height * step * slice(center, least + growth * (cuts[i] + step * (k + 0.5)));
        }
      }
    }
    return sum;
  }

 private:
  /// Force x, y and torque per unit of height where the sphere's outline has vertices at this radius.
  Eigen::Vector3d slice(const Eigen::Vector2d& center, double radius) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t j = 0; j < unit_.size(); ++j) {
      const Eigen::Vector2d from = center + radius * unit_[j];
      const Eigen::Vector2d to = center + radius * unit_[(j + 1) % unit_.size()];
      if (std::min(from.norm(), to.norm()) > cylinder_.front().norm() + (to - from).norm()) continue;
      const Inside part = clip(from, to, cylinder_);
      const Eigen::Vector2d inward = Eigen::Vector2d(from.y() - to.y(), to.x() - from.x()).normalized();
      const Eigen::Vector2d push = part.length * inward;
      const Eigen::Vector2d arm = part.middle - center;
      sum += Eigen::Vector3d(push.x(), push.y(), arm.x() * push.y() - arm.y() * push.x());
    }
    return sum;
  }

  int bands_;
  double sphere_;
  std::vector<Eigen::Vector2d> unit_;
  std::vector<Eigen::Vector2d> cylinder_;
};

TEST(Limit, ExactIsTheAnswerOfTheTessellatedSolids) {
  constexpr int k_facets = 96;
  const auto scenario = orbit_of(k_facets);
  const Recording recording = record_exact(*scenario, 25);
  const Slices slices(scenario->b().box().max().z(), polygon_radius(30.0, k_facets, RoundParts::equal_area), k_facets);
  std::vector<Eigen::Vector3d> forces;
  double torque_error = 0.0;
  for (std::size_t k = 0; k < recording.size(); ++k) {
    const Eigen::Vector3d own = slices.wrench(recording.poses[k].t.head<2>());
    forces.emplace_back(own.x(), own.y(), 0.0);
    torque_error = std::max(torque_error, std::abs(recording.torques[k].z() - own.z()));
  }
  EXPECT_LE(*sigma(forces, recording.forces), 1e-6);
  EXPECT_NEAR(fit_gain(forces, recording.forces)->gain, 1.0, k_slice_error);
  EXPECT_LE(*direction_error(forces, recording.forces).gamma_degrees, 1e-4);
  EXPECT_LE(torque_error, 1e-6 * peak(forces) * scenario->description().reference_length);
}

}  // namespace
}  // namespace sixdof
