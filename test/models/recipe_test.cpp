#include <sixdof/models/recipe.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "quality.h"

namespace sixdof {
namespace {

constexpr double k_cone_tessellation = 2e-3;  // of a centroid
constexpr double k_fine_tessellation = 1e-3;  // relative: with ten thousands of triangles

using ::testing::HasSubstr;

constexpr double k_pi = std::numbers::pi;

struct Known {
  // Smallest angle of any triangle from a thousand to a million triangles, degrees, as measured, rounded down.
  double angle_deg;
  // Content hashes with 1,000 and 10,000 triangles: the same bits on every machine and in every build.
  std::string hash_1k, hash_10k;
};

const std::map<std::string_view, Known>& known() {
  static const std::map<std::string_view, Known> table{
      {"sphere", {30, "8f631655beb8a28a1d26c33cb3db8484", "0277cfb144024dd93e53f2c72204ae21"}},
      {"bumpy-sphere", {27, "67ddc81991696d9b47d7289e6d63c0d1", "9b23309708550af86ca0b37d2b018e08"}},
      {"box", {43, "fc9f568b9a18b31b46bf726f709aac04", "fd795cb860f6b8b6b0db3d7aa66c97cd"}},
      {"cylinder", {40, "7bf4ac43c196371718cdea0cc9e890d5", "ddab621212f7255d5078e4c777ee6cbc"}},
      {"cone", {24, "1eb256ae23c667b0c1061c199a76786d", "64f3e92474b1730d030b918f8a8ff6d5"}},
      {"torus", {28, "f042ec844d0b8fa071308f7e18f0fd3c", "eee92414f04ac4edf76ed00334fda292"}},
      {"torus-knot", {29, "ffc79b81a9d044cd3239b0714d121cf7", "5fd2d9080cb5539947f0f455ad56b1d6"}},
      {"gyroid-ball", {4, "4617ff0cc25d27dd7080cd5589477e99", "4e90027f0b7e5560c4ae9c33873a9d29"}},
      {"circular-box", {12, "2e5bf90abc11e47bcaed4273088269bd", "54e9472b4f31c0708c42ed84eedadf0b"}},
  };
  return table;
}

class EveryRecipe : public ::testing::TestWithParam<Recipe> {};

void expect_valid(const Mesh& mesh, const Recipe& recipe, std::size_t triangles) {
  EXPECT_EQ(mesh.triangles().size(), triangles + triangles % 2);
  EXPECT_TRUE(mesh.solid()) << mesh.why_not_solid();
  EXPECT_TRUE(mesh.topology().manifold);
  EXPECT_EQ(mesh.topology().components, 1U);
  EXPECT_EQ(mesh.topology().euler_characteristic, 2 - 2 * static_cast<std::int64_t>(recipe.genus));
  EXPECT_EQ(mesh.repairs().welded_vertices, 0U);
  EXPECT_EQ(mesh.repairs().unreferenced_vertices, 0U);
  EXPECT_TRUE(mesh.repairs().zero_area_triangles.empty());
}

TEST_P(EveryRecipe, IsAClosedManifoldOfTheRequestedCount) {
  const Recipe& recipe = GetParam();
  for (const std::size_t n : {recipe.minimum, std::size_t{1000}, std::size_t{3457}, std::size_t{10000}}) {
    SCOPED_TRACE(n);
    expect_valid(recipe.make(n), recipe, n);
  }
}

TEST_P(EveryRecipe, IsValidAndWellShapedWithManyTriangles) {
  const Recipe& recipe = GetParam();
  const Mesh mesh = recipe.make(100'000);
  expect_valid(mesh, recipe, 100'000);
  EXPECT_GE(smallest_angle_deg(mesh), known().at(recipe.name).angle_deg);
}

TEST_P(EveryRecipe, IsWellShapedWithFewTriangles) {
  for (const std::size_t n : {1000U, 3456U, 10000U}) {
    EXPECT_GE(smallest_angle_deg(GetParam().make(n)), known().at(GetParam().name).angle_deg) << n;
  }
}

TEST_P(EveryRecipe, HasTheSameBitsEverywhere) {
  EXPECT_EQ(GetParam().make(1000).hash(), known().at(GetParam().name).hash_1k);
  EXPECT_EQ(GetParam().make(10000).hash(), known().at(GetParam().name).hash_10k);
}

TEST_P(EveryRecipe, RefusesCountsOutOfRange) {
  EXPECT_THROW(GetParam().make(GetParam().minimum - 1), BadArgument);
  EXPECT_THROW(GetParam().make(100'000'000), BadArgument);
}

INSTANTIATE_TEST_SUITE_P(Recipes, EveryRecipe, ::testing::ValuesIn(recipes().begin(), recipes().end()),
                         [](const auto& test) {
                           std::string name(test.param.name);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// The order with which an error falls with the number of triangles, from 2,000 to 32,000. Inscribed surfaces have
/// error ~ edge^2 ~ 1 / triangles: order 1.
double order_of(const std::function<double(std::size_t)>& error) { return std::log2(error(2000) / error(32000)) / 4.0; }
// Rounding of counts to whole rows moves the order by a few percent; about the cone's apex it is log(N) / N.
constexpr double k_order_margin = 0.12;

struct ClosedForm {
  std::string name;
  std::function<Mesh(std::size_t)> make;
  double volume, area;
};

void PrintTo(const ClosedForm& form, std::ostream* out) { *out << form.name; }

class Converges : public ::testing::TestWithParam<ClosedForm> {};

TEST_P(Converges, ToItsClosedFormsWithOrderOneInTheCount) {
  const ClosedForm& form = GetParam();
  EXPECT_NEAR(order_of([&](std::size_t n) { return std::abs(form.volume - form.make(n).volume()); }), 1.0,
              k_order_margin);
  EXPECT_NEAR(order_of([&](std::size_t n) { return std::abs(form.area - form.make(n).area()); }), 1.0, k_order_margin);
  // An inscribed regular polygon of m sides lacks 2 pi^2 / (3 m^2) of the area of its disc. With 32,000 triangles the
  // slimmest shape, the knot, has 31 sides around.
  EXPECT_NEAR(form.make(32000).volume() / form.volume, 1.0, 2.0 * k_pi * k_pi / (3.0 * 31 * 31));
}

const SphereShape k_sphere{.radius = 1.7};
const CylinderShape k_cylinder{.radius = 0.9, .height = 3.1};
const ConeShape k_cone{.radius = 1.3, .height = 2.6};
const TorusShape k_torus{.major_radius = 2.3, .minor_radius = 0.7};
const TorusKnotShape k_knot{
    .major_radius = 1.9, .minor_radius = 0.9, .tube_radius = 0.31, .revolutions = 2, .windings = 3};

/// Length of the knot's core: a polygon of a million chords, whose error is below 1e-10 of the length.
double core_length() {
  constexpr int k_chords = 1'000'000;
  const auto point = [](int i) {
    const double t = 2.0 * k_pi * i / k_chords;
    const double rho = k_knot.major_radius + k_knot.minor_radius * std::cos(k_knot.windings * t);
    return Eigen::Vector3d(rho * std::cos(k_knot.revolutions * t), rho * std::sin(k_knot.revolutions * t),
                           k_knot.minor_radius * std::sin(k_knot.windings * t));
  };
  double length = 0.0;
  for (int i = 0; i < k_chords; ++i) length += (point(i + 1) - point(i)).norm();
  return length;
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, Converges,
    ::testing::Values(ClosedForm{"sphere", [](std::size_t n) { return make_sphere(k_sphere, n); },
                                 4.0 / 3.0 * k_pi* std::pow(1.7, 3), 4.0 * k_pi * 1.7 * 1.7},
                      ClosedForm{"cylinder", [](std::size_t n) { return make_cylinder(k_cylinder, n); },
                                 k_pi * 0.9 * 0.9 * 3.1, 2.0 * k_pi * 0.9 * (0.9 + 3.1)},
                      ClosedForm{"cone", [](std::size_t n) { return make_cone(k_cone, n); },
                                 k_pi * 1.3 * 1.3 * 2.6 / 3.0, k_pi * 1.3 * (1.3 + std::hypot(1.3, 2.6))},
                      ClosedForm{"torus", [](std::size_t n) { return make_torus(k_torus, n); },
                                 2.0 * k_pi* k_pi * 2.3 * 0.7 * 0.7, 4.0 * k_pi* k_pi * 2.3 * 0.7},
                      // Pappus: a tube's volume is its section times the length of its core.
                      ClosedForm{"torus_knot", [](std::size_t n) { return make_torus_knot(k_knot, n); },
                                 k_pi * 0.31 * 0.31 * core_length(), 2.0 * k_pi * 0.31 * core_length()}),
    [](const auto& test) { return test.param.name; });

TEST(BumpySphere, ConvergesToTheQuadratureOfItsRadius) {
  const BumpySphereShape shape{.radius = 1.4, .amplitude = 0.09, .waves = 1.3};
  // Volume of a star-shaped body: the integral of r^3 / 3 over directions. Trapezium rule around, midpoint rule in z:
  // error below 1e-6 of the volume with these steps.
  constexpr int k_rows = 2000;
  constexpr int k_columns = 256;
  const auto wave = [&](double x) { return std::cos(2.0 * k_pi * shape.waves * x); };
  double volume = 0.0;
  for (int i = 0; i < k_rows; ++i) {
    const double z = -1.0 + (2.0 * i + 1.0) / k_rows;
    const double s = std::sqrt(1.0 - z * z);
    for (int j = 0; j < k_columns; ++j) {
      const double angle = 2.0 * k_pi * j / k_columns;
      const double bump = shape.amplitude * wave(s * std::cos(angle)) * wave(s * std::sin(angle)) * wave(z);
      volume += std::pow(shape.radius * (1.0 + bump), 3) / 3.0;
    }
  }
  volume *= 4.0 * k_pi / (k_rows * k_columns);
  EXPECT_NEAR(order_of([&](std::size_t n) { return volume - make_bumpy_sphere(shape, n).volume(); }), 1.0,
              2.0 * k_order_margin);
  EXPECT_NEAR(make_bumpy_sphere(shape, 32000).volume() / volume, 1.0, k_fine_tessellation);
}

// Sums of a few thousand terms near 1.
constexpr double k_rounding = 1e-12;

TEST(Boxes, AreTheSameSolidAtEveryCount) {
  const BoxShape box{.size = {0.7, 1.9, 3.3}};
  const CircularBoxShape ring{
      .outer_radius = 1.3, .inner_radius = 0.8, .height = 0.4, .beam = 0.07, .frame_fraction = 0.3, .sectors = 9};
  // A sector of the ring is a frame with a window, followed by four beams.
  const double R = 1.3, r = 0.8, h = 0.4, b = 0.07;
  const double sine_of_frame = std::sin(2.0 * k_pi * 0.3 / 9), sine_of_opening = std::sin(2.0 * k_pi * 0.7 / 9);
  const double window = ((R - b) * (R - b) - (r + b) * (r + b)) * (h - 2.0 * b);
  const double beams = ((R * R - (R - b) * (R - b)) + ((r + b) * (r + b) - r * r)) * 2.0 * b;
  const double ring_volume = 9 * 0.5 * (sine_of_frame * ((R * R - r * r) * h - window) + sine_of_opening * beams);
  const double ring_area = make_circular_box(ring, minimum_triangles(ring)).area();
  for (const std::size_t n : {std::size_t{720}, std::size_t{2222}, std::size_t{20000}}) {
    EXPECT_NEAR(make_box(box, n).volume(), 0.7 * 1.9 * 3.3, k_rounding);
    EXPECT_NEAR(make_box(box, n).area(), 2.0 * (0.7 * 1.9 + 1.9 * 3.3 + 3.3 * 0.7), k_rounding);
    EXPECT_EQ(make_box(box, n).box().max(), Eigen::Vector3d(0.35, 0.95, 1.65));
    EXPECT_NEAR(make_circular_box(ring, n).volume(), ring_volume, k_rounding);
    EXPECT_NEAR(make_circular_box(ring, n).area(), ring_area, k_rounding);
    EXPECT_EQ(make_circular_box(ring, n).topology().euler_characteristic, 2 - 2 * (4 * 9 + 1));
  }
}

TEST(Shapes, LieInTheStatedFrame) {
  const Mesh cone = make_cone({.radius = 1.3, .height = 2.6}, 5000);
  EXPECT_EQ(cone.box().min().z(), 0.0);
  EXPECT_EQ(cone.box().max().z(), 2.6);
  EXPECT_NEAR(cone.centroid().z(), 2.6 / 4.0,
              k_cone_tessellation);  // that of the ideal cone, of which the inscribed one lacks a part
  EXPECT_NEAR(cone.centroid().head<2>().norm(), 0.0, k_fine_tessellation);
  const Mesh cylinder = make_cylinder({.radius = 0.9, .height = 3.1}, 5000);
  EXPECT_EQ(cylinder.box().min().z(), -1.55);
  EXPECT_EQ(cylinder.box().max().z(), 1.55);
  const Mesh torus = make_torus({.major_radius = 2.3, .minor_radius = 0.7}, 5000);
  for (const Eigen::Vector3d& p : torus.vertices()) {
    EXPECT_NEAR(std::hypot(p.head<2>().norm() - 2.3, p.z()), 0.7, k_rounding);
  }
  for (const Eigen::Vector3d& p : cone.vertices()) {
    const bool on_base = p.z() == 0.0 && p.head<2>().norm() < 1.3 * (1.0 + k_rounding);
    EXPECT_TRUE(on_base || std::abs(p.head<2>().norm() - 1.3 * (1.0 - p.z() / 2.6)) < k_rounding);
  }
}

TEST(Shapes, RefuseLengthsWithoutASolid) {
  EXPECT_THROW(make_sphere({.radius = 0.0}, 100), BadArgument);
  EXPECT_THROW(make_box({.size = {1.0, -1.0, 1.0}}, 100), BadArgument);
  EXPECT_THROW(make_cone({.radius = 1.0, .height = std::nan("")}, 100), BadArgument);
  EXPECT_THROW(make_torus({.major_radius = 1.0, .minor_radius = 1.0}, 100), BadArgument);
  EXPECT_THROW(make_circular_box({.beam = 0.25}, 2000), BadArgument);
  EXPECT_THROW(make_torus_knot({.revolutions = 2, .windings = 4}, 1000), BadArgument);
  try {
    make_torus_knot({.major_radius = 1.0, .minor_radius = 0.5, .tube_radius = 0.45}, 1000);
    FAIL() << "a tube that meets itself was made";
  } catch (const BadArgument& e) {
    EXPECT_THAT(e.what(), HasSubstr("torus-knot: "));
  }
}

}  // namespace
}  // namespace sixdof
