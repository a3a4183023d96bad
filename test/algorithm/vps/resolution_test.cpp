// The resolution that the algorithms of points and voxels declare: the surfaces that they see lie within it.

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/algorithm/vps/pointshell.h>
#include <sixdof/algorithm/vps/vps.h>
#include <sixdof/geometry/closest_point.h>
#include <sixdof/models/recipe.h>
#include <sixdof/oracle/winding.h>

#include "bodies.h"

namespace sixdof {
namespace {

struct Choice {
  const char* algorithm;
  bool coarsest;  ///< Of the sweep; otherwise the default.
};

class VpsResolution : public ::testing::TestWithParam<Choice> {
 protected:
  std::unique_ptr<Algorithm> make() const {
    return std::string_view(GetParam().algorithm) == "vps" ? make_vps_algorithm() : make_vps_field_algorithm();
  }
  Settings settings() const {
    const auto algorithm = make();
    Settings chosen = algorithm->settings();
    if (GetParam().coarsest) {
      for (const Parameter& p : algorithm->traits().parameters) {
        if (!p.sweep.empty()) chosen.set(p.name, p.sweep.front());
      }
    }
    return chosen;
  }
};

double declared(const Query& query) {
  for (const auto& [name, value] : query.footprint().counts) {
    if (name == "resolution") return value;
  }
  return 0.0;
}

/// B is a body of a few voxels at most, so that the surface of A that its points see is at B, up to B's size.
TEST_P(VpsResolution, TheSurfaceOfAIsWithinIt) {
  const auto algorithm = make();
  const Mesh box = make_circular_box({}, 2000);
  for (const Mesh& a : {make_bumpy_sphere({}, 1000), box}) {
    const Mesh b = make_sphere({.radius = 1e-3 * a.diagonal()}, 80);
    const auto query = algorithm->prepare(a, b, settings());
    const double resolution = declared(*query), size_of_b = 2e-3 * a.diagonal();
    const Tree tree(a);
    constexpr double k_half_beam = 0.05;  // of the circular box; coarser resolutions leave nothing of its inside
    const bool has_inside = a.name() != box.name() || resolution + size_of_b < 0.8 * k_half_beam;
    std::size_t outside = 0, inside = 0;
    std::vector<std::uint32_t> scratch;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
      const Eigen::Vector3d p = vps_test::generic_pose(seed, 1.0).t.cwiseProduct(0.55 * a.box().sizes());
      const Pose X{vps_test::generic_pose(seed + 9999, 1.0).R, (0.2 + 1e-3 * static_cast<double>(seed % 1000)) * p};
      const auto nearest = closest_point(tree, X.t);
      if (nearest->distance < resolution + size_of_b) continue;
      const bool is_inside = detail::winding_of_a(tree, X.t, scratch) != 0;
      ++(is_inside ? inside : outside);
      EXPECT_EQ(query->collide(X).value, is_inside) << seed << ' ' << nearest->distance / resolution;
      EXPECT_EQ(query->respond(X).value.penalty > 0.0, is_inside) << seed;
    }
    EXPECT_GT(outside, 100u) << a.name();
    EXPECT_TRUE(inside > 20u || !has_inside) << a.name() << ' ' << inside;
  }
}

/// Between the points of B's shell: no point of the surface is farther from one than the spacing that is declared.
TEST_P(VpsResolution, TheShellOfBCoversItsSurface) {
  for (const Mesh& b : {make_bumpy_sphere({}, 1000), make_circular_box({}, 2000)}) {
    const double spacing = settings().number("point_spacing") * b.diagonal();
    const vps::PointShell shell = vps::PointShell::build(b, spacing);
    const Tree tree(b);
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const Eigen::Vector3d p = closest_point(tree, vps_test::generic_pose(seed, 0.5 * b.diagonal()).t)->point;
      double least = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3d& point : shell.points) least = std::min(least, (p - point).norm());
      EXPECT_LE(least, spacing) << b.name() << ' ' << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, VpsResolution,
                         ::testing::Values(Choice{"vps", true}, Choice{"vps", false}, Choice{"vps-field", true},
                                           Choice{"vps-field", false}),
                         [](const auto& made) {
                           std::string name = made.param.algorithm;
                           std::erase(name, '-');
                           return name + (made.param.coarsest ? "Coarsest" : "AtDefaults");
                         });

}  // namespace
}  // namespace sixdof
