#include <sixdof/algorithm/ist/normal_cone.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <sixdof/algorithm/ist/packing.h>
#include <sixdof/base/parallel.h>
#include <sixdof/geometry/closest_point.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/models/recipe.h>

namespace sixdof::ist {
namespace {

constexpr double k_cosine_tolerance = 1e-9;  // of the iteration for the narrowest cone, in the cosine of its angle

constexpr double k_rounding = 1e-12;
constexpr double k_angle_rounding = 3e-6;  // of an angle near 0 whose cosine is off by k_rounding

Eigen::Vector3d random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Vector3d(x, y, z).normalized();
}

bool contains(const Eigen::Vector3d& axis, double cosine, const std::vector<Eigen::Vector3d>& directions) {
  return std::ranges::all_of(directions, [&](const auto& v) { return axis.dot(v) >= cosine - 1e-9; });
}

/// The narrowest of all cones through two or three of the vectors that contain the others; cosine -1 if none does.
std::pair<Eigen::Vector3d, double> narrowest_of_all(const std::vector<Eigen::Vector3d>& d) {
  std::pair<Eigen::Vector3d, double> best{Eigen::Vector3d::Zero(), -1.0};
  const auto consider = [&](const Eigen::Vector3d& axis, double cosine) {
    if (cosine > best.second && contains(axis, cosine, d)) best = {axis, cosine};
  };
  for (std::size_t i = 0; i < d.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Vector3d middle = (d[i] + d[j]).normalized();
      consider(middle, middle.dot(d[i]));
      for (std::size_t k = 0; k < j; ++k) {
        const Eigen::Vector3d axis = (d[j] - d[i]).cross(d[k] - d[i]).normalized();
        consider(axis, axis.dot(d[i]));
        consider(-axis, -axis.dot(d[i]));
      }
    }
  }
  return best;
}

TEST(NarrowestCone, IsTheNarrowestOfAllThatContainTheVectors) {
  std::mt19937_64 random(51);
  int with_axis = 0, without = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d about = random_direction(random);
    const double spread = 0.02 * (i % 60 + 1);
    std::vector<Eigen::Vector3d> directions;
    for (int k = 0; k < 3 + i % 20; ++k) directions.push_back((about + spread * random_direction(random)).normalized());
    const auto [axis, cosine] = narrowest_of_all(directions);
    const NormalCone cone = narrowest_cone(directions);
    if (cosine < std::cos(k_widest_half_angle)) {
      EXPECT_TRUE(cone.axis.isZero()) << i;
      EXPECT_EQ(cone.half_angle, std::numbers::pi) << i;
      ++without;
      continue;
    }
    EXPECT_NEAR(std::cos(cone.half_angle), cosine, k_rounding) << i;
    EXPECT_LE((cone.axis - axis).norm(), 1e-9) << i;
    ++with_axis;
  }
  EXPECT_GT(with_axis, 150);
  EXPECT_GT(without, 10);
}

TEST(NarrowestCone, HasNoAxisForOppositeVectorsOrNone) {
  const Eigen::Vector3d u(0.6, 0.0, 0.8), v(0.0, 1.0, 0.0);
  EXPECT_TRUE(narrowest_cone(std::vector<Eigen::Vector3d>{}).axis.isZero());
  EXPECT_TRUE(narrowest_cone(std::vector<Eigen::Vector3d>{u, -u}).axis.isZero());
  EXPECT_TRUE(narrowest_cone(std::vector<Eigen::Vector3d>{u, -u, v, -v}).axis.isZero());
  const NormalCone one = narrowest_cone(std::vector<Eigen::Vector3d>{u, u, u});
  EXPECT_EQ(one.axis, u);
  EXPECT_NEAR(one.half_angle, 0.0, k_angle_rounding);
}

/// A box from -1 to 1 in x, y and z, rotated.
class ConesInABox : public ::testing::Test {
 protected:
  NormalCone cone_of(const Sphere& sphere, std::size_t triangles) const {
    Mesh box = make_box({.size = {2.0, 2.0, 2.0}}, triangles);
    std::vector<Eigen::Vector3d> vertices = box.vertices();
    for (Eigen::Vector3d& v : vertices) v = R_ * v;
    // A large sphere in the middle is nearest to most triangles.
    const std::vector<Sphere> spheres{{Eigen::Vector3d::Zero(), 0.9}, {R_ * sphere.center, sphere.radius}};
    NormalCone cone = normal_cones(Mesh::build(vertices, box.triangles(), "box"), spheres)[1];
    cone.axis = R_.transpose() * cone.axis;
    return cone;
  }
  const Eigen::Matrix3d R_ = Eigen::AngleAxisd(0.9, Eigen::Vector3d(0.48, -0.6, 0.64)).toRotationMatrix();
};

TEST_F(ConesInABox, NextToAFaceTheAxisIsItsNormal) {
  for (const std::size_t triangles : {12u, 1200u}) {
    const NormalCone cone = cone_of({{0.1, 0.95, 0.2}, 0.05}, triangles);
    EXPECT_LE((cone.axis - Eigen::Vector3d::UnitY()).norm(), k_rounding) << triangles;
    EXPECT_NEAR(cone.half_angle, 0.0, k_angle_rounding) << triangles;
  }
}

TEST_F(ConesInABox, AlongAnEdgeAndInACornerTheAxisIsBetweenTheNormals) {
  for (const std::size_t triangles : {12u, 1200u}) {
    const NormalCone edge = cone_of({{0.1, 0.95, -0.95}, 0.05}, triangles);
    EXPECT_LE((edge.axis - Eigen::Vector3d(0.0, 1.0, -1.0).normalized()).norm(), k_rounding) << triangles;
    EXPECT_NEAR(edge.half_angle, std::numbers::pi / 4.0, k_angle_rounding) << triangles;
    // Touches one face and nearly touches the two others.
    const NormalCone corner = cone_of({{0.95, 0.949, 0.948}, 0.05}, triangles);
    EXPECT_LE((corner.axis - Eigen::Vector3d(1.0, 1.0, 1.0).normalized()).norm(), k_rounding) << triangles;
    EXPECT_NEAR(std::cos(corner.half_angle), 1.0 / std::sqrt(3.0), k_rounding) << triangles;
  }
}

TEST_F(ConesInABox, DeepInsideTheAxisIsTheWayToTheClosestFaceIfThereIsOne) {
  const NormalCone deep = cone_of({{0.1, -0.2, 0.4}, 0.01}, 12);
  EXPECT_LE((deep.axis - Eigen::Vector3d::UnitZ()).norm(), k_rounding);
  // Six faces are equally near.
  const NormalCone center = cone_of({{0.0, 0.0, 0.0}, 0.01}, 12);
  EXPECT_TRUE(center.axis.isZero());
  EXPECT_EQ(center.half_angle, std::numbers::pi);
}

/// The two rules over all triangles and all spheres, without trees.
std::vector<Eigen::Vector3d> normals_by_brute_force(const Mesh& mesh, const std::vector<Sphere>& spheres,
                                                    std::size_t sphere) {
  const Sphere& s = spheres[sphere];
  struct Face {
    double nearest_distance;
    bool nearest_is_s;
    Eigen::Vector3d normal;
  };
  std::vector<Face> faces;
  double closest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles()) {
    const Tree::Corners c{mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]};
    const Eigen::Vector3d centroid = (c[0] + c[1] + c[2]) / 3.0;
    const auto gap = [&](const Sphere& o) { return (centroid - o.center).norm() - o.radius; };
    const auto nearest = std::ranges::min_element(spheres, {}, gap);
    const double distance = (closest_point_on_triangle(s.center, c) - s.center).norm();
    closest = std::min(closest, distance);
    faces.push_back({distance, nearest - spheres.begin() == static_cast<std::ptrdiff_t>(sphere),
                     (c[1] - c[0]).cross(c[2] - c[0]).normalized()});
  }
  std::vector<Eigen::Vector3d> normals;
  for (const Face& f : faces) {
    if (f.nearest_is_s || f.nearest_distance <= closest + k_touch_radii * s.radius) normals.push_back(f.normal);
  }
  return normals;
}

TEST(NormalCones, AreThoseOfBruteForceOnDetailedBodies) {
  for (const char* name : {"torus-knot-1k", "bumpy-sphere-1k"}) {
    const Mesh mesh = load_model(name);
    const std::vector<Sphere> spheres = pack_spheres(mesh, {.spheres = 80}).spheres;
    const std::vector<NormalCone> cones = normal_cones(mesh, spheres);
    ASSERT_EQ(cones.size(), spheres.size());
    int with_axis = 0;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const std::vector<Eigen::Vector3d> normals = normals_by_brute_force(mesh, spheres, i);
      ASSERT_FALSE(normals.empty());
      if (cones[i].axis.isZero()) continue;
      // An axis that was left out without need would show as too few.
      EXPECT_TRUE(contains(cones[i].axis, std::cos(cones[i].half_angle), normals)) << name << ' ' << i;
      EXPECT_NEAR(std::cos(narrowest_cone(normals).half_angle), std::cos(cones[i].half_angle), k_cosine_tolerance)
          << name << ' ' << i;
      ++with_axis;
    }
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      if (cones[i].axis.isZero()) {
        EXPECT_TRUE(narrowest_cone(normals_by_brute_force(mesh, spheres, i)).axis.isZero()) << name << ' ' << i;
      }
    }
    EXPECT_GT(with_axis, 40) << name;
  }
}

TEST(NormalCones, DoNotDependOnTheNumberOfThreads) {
  const Mesh mesh = load_model("torus-knot-1k");
  const std::vector<Sphere> spheres = pack_spheres(mesh, {.spheres = 200}).spheres;
  const auto with = [&](unsigned threads) {
    std::vector<double> numbers;
    parallel::with_threads(threads, [&] {
      for (const NormalCone& c : normal_cones(mesh, spheres)) {
        numbers.insert(numbers.end(), {c.axis.x(), c.axis.y(), c.axis.z(), c.half_angle});
      }
    });
    return numbers;
  };
  EXPECT_EQ(with(1), with(2));
}

}  // namespace
}  // namespace sixdof::ist
