#include <sixdof/scenario/solids.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_rounding = 1e-12;  // relative, of volumes summed over some thousand triangles

void expect_closed_manifold(const Mesh& mesh, std::int64_t euler) {
  EXPECT_TRUE(mesh.solid()) << mesh.name() << ": " << mesh.why_not_solid();
  EXPECT_TRUE(mesh.topology().manifold) << mesh.name();
  EXPECT_EQ(mesh.topology().components, 1u) << mesh.name();
  EXPECT_EQ(mesh.topology().euler_characteristic, euler) << mesh.name();
  EXPECT_EQ(mesh.repairs().collapsed_triangles, 0u) << mesh.name();
  EXPECT_TRUE(mesh.repairs().zero_area_triangles.empty()) << mesh.name();
}

TEST(Solids, AreClosedManifolds) {
  for (const int facets : {8, 9, 33, 96}) {
    for (const RoundParts round : {RoundParts::inscribed, RoundParts::equal_area}) {
      expect_closed_manifold(cone_solid(3.0, 6.1, facets, round, "cone"), 2);
      expect_closed_manifold(cylinder_solid(3.0, 6.1, facets, round, "cylinder"), 2);
      expect_closed_manifold(sphere_solid(3.0, facets, round, "sphere"), 2);
      PinsShape shape;
      shape.facets = facets;
      shape.round = round;
      expect_closed_manifold(holes_solid(shape, "holes"), -2);  // genus 2
      expect_closed_manifold(pins_solid(shape, "pins"), 2);
    }
  }
  expect_closed_manifold(box_solid({-0.3, 0.2, -1.0}, {0.9, 1.4, 5.0}, "box"), 2);
}

TEST(Solids, EqualAreaMakesVolumesExact) {
  const int facets = 22;
  const auto round = RoundParts::equal_area;
  EXPECT_NEAR(cone_solid(3.0, 6.1, facets, round, "").volume() / (k_pi * 9.0 * 6.1 / 3.0), 1.0, k_rounding);
  EXPECT_NEAR(cylinder_solid(3.0, 6.1, facets, round, "").volume() / (k_pi * 9.0 * 6.1), 1.0, k_rounding);
  EXPECT_NEAR(sphere_solid(3.0, facets, round, "").volume() / (k_pi * 36.0), 1.0, k_rounding);
  EXPECT_NEAR(box_solid({-0.3, 0.2, -1.0}, {0.9, 1.4, 5.0}, "").volume(), 1.2 * 1.2 * 6.0, k_rounding);
}

TEST(Solids, PinsAndHolesComplementEachOther) {
  for (const RoundParts round : {RoundParts::inscribed, RoundParts::equal_area}) {
    PinsShape shape;
    shape.facets = 21;
    shape.width = 77.0;
    shape.round = round;
    const double slab = shape.width * shape.depth;
    const double polygon_area =
        0.5 * 21 * std::sin(2.0 * k_pi / 21) * std::pow(polygon_radius(shape.round_radius, 21, round), 2);
    const double pins = (400.0 + polygon_area) * shape.depth;
    EXPECT_NEAR(holes_solid(shape, "").volume() / (slab * shape.depth - pins), 1.0, k_rounding);
    EXPECT_NEAR(pins_solid(shape, "").volume() / (slab * shape.plate_thickness + pins), 1.0, k_rounding);
    if (round == RoundParts::equal_area) {
      EXPECT_NEAR(polygon_area, k_pi * 100.0, k_rounding * 1000);
    }
  }
}

TEST(Solids, InscribedConvergesWithTheSquareOfTheFacets) {
  const auto error = [](int facets) {
    return 1.0 - cylinder_solid(3.0, 6.1, facets, RoundParts::inscribed, "").volume() / (k_pi * 9.0 * 6.1);
  };
  EXPECT_NEAR(std::log2(error(64) / error(128)), 2.0, 0.01);
  EXPECT_GT(error(64), 0.0);
}

/// Overlapping or folded triangles would make the surface too large.
TEST(Solids, SurfacesDoNotFold) {
  for (const int facets : {21, 96}) {
    PinsShape shape;
    shape.facets = facets;
    shape.width = 77.0;
    const double vertex = polygon_radius(shape.round_radius, facets, shape.round);
    const double round_walls = facets * 2.0 * vertex * std::sin(k_pi / facets) * shape.depth;
    const double square_walls = 4.0 * shape.square_side * shape.depth;
    const double slab = shape.width * shape.depth;
    const double holes = 400.0 + k_pi * 100.0;
    const double outline = 2.0 * (shape.width + shape.depth);
    const double block = outline * shape.depth + square_walls + round_walls + 2.0 * (slab - holes);
    EXPECT_NEAR(holes_solid(shape, "").area() / block, 1.0, k_rounding);
    const double pins = outline * shape.plate_thickness + square_walls + round_walls + 2.0 * slab;
    EXPECT_NEAR(pins_solid(shape, "").area() / pins, 1.0, k_rounding);
  }
}

TEST(Solids, SphereIsMadeOfEqualBands) {
  const Mesh sphere = sphere_solid(3.0, 24, RoundParts::inscribed, "");
  EXPECT_EQ(sphere.triangles().size(), 2u * 24u * 11u);
  EXPECT_LT(sphere.centroid().norm(), k_rounding);
  for (const Eigen::Vector3d& v : sphere.vertices()) EXPECT_NEAR(v.norm(), 3.0, k_rounding);
  EXPECT_NEAR(sphere.box().max().z(), 3.0, k_rounding);
  // The widest ring is the equator.
  EXPECT_NEAR(sphere.box().max().x(), 3.0 * std::cos(k_pi / 24), k_rounding);
}

/// No vertex is on an axis, so flat walls of other solids do not touch one exactly.
TEST(Solids, PolygonsStartHalfAFacetFromTheAxis) {
  const auto loop = polygon(2.0, 10, RoundParts::inscribed);
  EXPECT_NEAR(std::atan2(loop[0].y(), loop[0].x()), k_pi / 10, k_rounding);
  EXPECT_NEAR(std::atan2(loop[1].y(), loop[1].x()), 3.0 * k_pi / 10, k_rounding);
}

TEST(Solids, BoxesAreWhereTheDocumentationSays) {
  const Mesh cone = cone_solid(3.0, 6.1, 16, RoundParts::inscribed, "");
  EXPECT_EQ(cone.box().min().y(), 0.0);
  EXPECT_EQ(cone.box().max().y(), 6.1);
  const PinsShape shape;
  EXPECT_EQ(pins_solid(shape, "").box().min(), Eigen::Vector3d(-40, -20, -40));
  EXPECT_EQ(pins_solid(shape, "").box().max(), Eigen::Vector3d(40, 20, 10));
  EXPECT_EQ(holes_solid(shape, "").box().max(), Eigen::Vector3d(40, 20, 0));
}

}  // namespace
}  // namespace sixdof
