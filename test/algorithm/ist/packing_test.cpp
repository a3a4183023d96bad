#include <sixdof/algorithm/ist/packing.h>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>

namespace sixdof::ist {
namespace {

constexpr double k_rounding = 1e-12;     // of a sum over the spheres
constexpr double k_scale_change = 0.01;  // relative: limits of the search are not scaled, so other spheres may be found
constexpr double k_solid_angle_rounding = 1e-9;  // of a sum of some thousand arcs

PackingOptions at_most(std::size_t spheres) { return {.spheres = spheres}; }

/// Solid angle of the surface seen from p, over 4 pi: 1 inside, 0 outside (van Oosterom and Strackee 1983).
double winding_number(const Mesh& mesh, const Eigen::Vector3d& p) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    const Eigen::Vector3d a = mesh.vertices()[t[0]] - p, b = mesh.vertices()[t[1]] - p, c = mesh.vertices()[t[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * std::numbers::pi);
}

TEST(Packing, SpheresAreInsideAndDisjoint) {
  for (const char* name : {"torus-knot-2k", "circular-box-2k", "bumpy-sphere-1k"}) {
    const Mesh mesh = load_model(name);
    const Tree tree(mesh);
    const Packing packing = pack_spheres(mesh, at_most(400));
    ASSERT_EQ(packing.spheres.size(), 400u) << name;
    double worst_surface = 1.0, worst_pair = 1.0;
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      const Sphere& s = packing.spheres[i];
      worst_surface = std::min(worst_surface, closest_point(tree, s.center)->distance / s.radius - 1.0);
      for (std::size_t j = 0; j < i; ++j) {
        const Sphere& o = packing.spheres[j];
        worst_pair = std::min(worst_pair, ((s.center - o.center).norm() - s.radius - o.radius) / s.radius);
      }
      if (i % 20 == 0) {
        EXPECT_NEAR(winding_number(mesh, s.center), 1.0, k_solid_angle_rounding) << name << ' ' << i;
      }
    }
    EXPECT_GT(worst_surface, 0.0) << name;
    EXPECT_GT(worst_pair, 0.0) << name;
  }
}

/// A point just below a face of a part without thickness is outside the body.
TEST(Packing, PutsNoSphereNextToPartsWithoutThickness) {
  std::vector<Eigen::Vector3d> vertices;
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : {std::pair(0.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) vertices.emplace_back(x, y, z);
  }
  std::vector<Triangle> triangles;
  constexpr std::uint32_t k_sides[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                           {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  for (const auto& side : k_sides) {
    triangles.push_back({side[0], side[1], side[2]});
    triangles.push_back({side[0], side[2], side[3]});
  }
  // Far from the box, the same triangle twice, back to back.
  for (const auto& [x, y] : {std::pair(2.0, 0.0), {3.0, 0.0}, {2.0, 1.0}}) vertices.emplace_back(x, y, 0.0);
  triangles.push_back({8, 9, 10});
  triangles.push_back({8, 10, 9});
  const Mesh mesh = Mesh::build(vertices, triangles, "box-and-flap");
  ASSERT_TRUE(mesh.solid()) << mesh.why_not_solid();
  const Packing packing = pack_spheres(mesh, at_most(100));
  EXPECT_EQ(packing.spheres.size(), 100u);
  EXPECT_GT(packing.fill, 0.7);
  EXPECT_LT(packing.fill, 1.0);
  for (const Sphere& s : packing.spheres) {
    EXPECT_GE(s.center.minCoeff(), s.radius);
    EXPECT_LE(s.center.maxCoeff(), 1.0 - s.radius);
  }
}

TEST(Packing, FindsTheLargestSphereAndFillsWell) {
  const Mesh ball = load_model("sphere-2k");
  const Packing one = pack_spheres(ball, at_most(1));
  EXPECT_GT(one.spheres.front().radius, 0.97);  // the tessellated ball's inscribed radius is just below 1
  EXPECT_LT(one.spheres.front().radius, 1.0);

  // The largest spheres come first, but for those of one round and for maxima that are missed.
  const Mesh knot = load_model("torus-knot-2k");
  const Packing many = pack_spheres(knot, at_most(2000));
  double smallest = many.spheres.front().radius;
  for (std::size_t i = 1; i < many.spheres.size(); ++i) {
    EXPECT_LT(many.spheres[i].radius, 1.5 * smallest) << i;
    smallest = std::min(smallest, many.spheres[i].radius);
  }
  EXPECT_GT(many.fill, 0.7);
  EXPECT_LT(many.fill, 1.0);
  EXPECT_GT(many.fill, pack_spheres(knot, at_most(200)).fill + 0.05);
}

/// Fill rate of this body by 10,000 spheres: a record of what this packing reaches, between two bounds.
constexpr double k_lowest_fill = 0.83, k_highest_fill = 0.88;

TEST(Packing, FillsATorusKnotByMoreThanFourFifths) {
  const Mesh mesh = load_model("torus-knot-2k");
  const Packing packing = pack_spheres(mesh, at_most(10'000));
  EXPECT_EQ(packing.spheres.size(), 10'000u);
  EXPECT_GT(packing.fill, k_lowest_fill);
  EXPECT_LT(packing.fill, k_highest_fill);
  double volume = 0.0;  // by a formula of its own: pi d^3 / 6
  for (const Sphere& s : packing.spheres) volume += std::numbers::pi / 6.0 * std::pow(2.0 * s.radius, 3);
  EXPECT_NEAR(packing.fill, volume / mesh.volume(), k_rounding);
}

Mesh scaled(const Mesh& mesh, double factor) {
  std::vector<Eigen::Vector3d> vertices = mesh.vertices();
  for (Eigen::Vector3d& v : vertices) v *= factor;
  return Mesh::build(vertices, mesh.triangles(), mesh.name());
}

TEST(Packing, DoesNotDependOnTheUnitOfLength) {
  const Mesh mesh = load_model("torus-knot-1k");
  const Packing plain = pack_spheres(mesh, at_most(200));
  for (const double factor : {0x1p-40, 0x1p40}) {  // powers of two: the same roundings
    const Mesh other = scaled(mesh, factor);
    const Packing packing = pack_spheres(other, at_most(200));
    EXPECT_NEAR(packing.fill, plain.fill, k_scale_change) << factor;
    EXPECT_NEAR(packing.spheres.front().radius / factor, plain.spheres.front().radius, k_scale_change) << factor;
  }
}

TEST(Packing, AThinPlateIsFilledFromWallToWall) {
  const double thickness = 0.002;
  const Mesh plate = make_box({.size = {1.0, 0.8, thickness}}, 12);
  const Packing packing = pack_spheres(plate, at_most(300));
  ASSERT_EQ(packing.spheres.size(), 300u);
  for (const Sphere& s : packing.spheres) {
    EXPECT_LE(std::abs(s.center.z()) + s.radius, 0.5 * thickness);
    EXPECT_GT(s.radius, 0.4 * thickness);  // hardly any is needed elsewhere
  }
}

/// The second largest sphere is between the inscribed sphere and the tip, where a prototype has to follow a wedge.
TEST(Packing, FollowsAConeIntoItsTip) {
  const Mesh cone = load_model("cone-1k");  // base radius 1, height 2, apex up
  const double sine = 1.0 / std::sqrt(5.0), inscribed = 2.0 / (1.0 + std::sqrt(5.0));
  const double ratio = (1.0 - sine) / (1.0 + sine);
  const Packing packing = pack_spheres(cone, at_most(3));
  constexpr double k_near = 0.02;  // flat sides, and k_min_gain of the optimisation
  EXPECT_NEAR(packing.spheres[0].radius, inscribed, k_near);
  EXPECT_NEAR(packing.spheres[1].radius, ratio * inscribed, k_near);
  EXPECT_NEAR(packing.spheres[1].center.z(), 2.0 - ratio * inscribed / sine, k_near);
}

TEST(Packing, StopsAtTheFillRateAndTheSmallestRadius) {
  const Mesh mesh = load_model("box-1k");
  PackingOptions options = at_most(5000);
  options.fill = 0.6;
  const Packing filled = pack_spheres(mesh, options);
  EXPECT_GE(filled.fill, 0.6);
  EXPECT_LT(filled.fill, 0.7);
  options = at_most(5000);
  options.smallest_radius = 0.04;
  const Packing coarse = pack_spheres(mesh, options);
  EXPECT_LT(coarse.spheres.size(), 5000u);
  for (const Sphere& s : coarse.spheres) EXPECT_GE(s.radius, 0.04 * mesh.diagonal() * (1.0 - 1e-8));
}

TEST(Packing, SameBitsForAnyNumberOfThreads) {
  const Mesh mesh = load_model("torus-knot-1k");
  const Tree tree(mesh);
  const auto pack_with = [&](unsigned threads) {
    std::vector<Sphere> spheres;
    parallel::with_threads(threads, [&] { spheres = pack_spheres(mesh, at_most(300)).spheres; });
    return spheres;
  };
  const auto one = pack_with(1), two = pack_with(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].center, two[i].center);
    EXPECT_EQ(one[i].radius, two[i].radius);
  }
}

TEST(Packing, RefusesMeshesThatAreNotSolidOrTooThin) {
  const Mesh open =
      Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}, "open");
  EXPECT_THROW(pack_spheres(open, at_most(10)), BadMesh);
  std::vector<Triangle> inwards = load_model("torus-1k").triangles();
  for (Triangle& t : inwards) std::swap(t[1], t[2]);
  const Mesh inside_out = Mesh::build(load_model("torus-1k").vertices(), inwards, "inside-out");
  EXPECT_THAT([&] { pack_spheres(inside_out, at_most(10)); },
              ::testing::ThrowsMessage<BadMesh>(::testing::HasSubstr("inside out")));
  // A plate a thousand times thinner than the smallest sphere.
  const Mesh plate = Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1e-7}},
                                 {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, "plate");
  try {
    pack_spheres(plate, at_most(10));
    FAIL();
  } catch (const BadMesh& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("too thin"));
  }
}

}  // namespace
}  // namespace sixdof::ist
