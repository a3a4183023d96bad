#include <sixdof/oracle/mesh_check.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/models/recipe.h>

#include "../geometry/shapes.h"

namespace sixdof {
namespace {

constexpr double k_plane_rounding = 1e-12;  // of a point in a plane

/// Several meshes as one.
Mesh joined(const std::vector<Mesh>& parts) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  for (const Mesh& part : parts) {
    const auto offset = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), part.vertices().begin(), part.vertices().end());
    for (const Triangle& t : part.triangles()) triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return Mesh::build(std::move(vertices), std::move(triangles), "joined");
}

Mesh inside_out(const Mesh& mesh) {
  std::vector<Triangle> triangles = mesh.triangles();
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
  return Mesh::build(mesh.vertices(), std::move(triangles), "inside out");
}

/// A generic pose, so that nothing is parallel to an axis.
Mesh turned(const Mesh& mesh) {
  shapes::Generator generator(20261122);
  return shapes::moved(mesh, shapes::random_pose(generator, 0.7));
}

Mesh ball(double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero()) {
  return shapes::bumpy_sphere(2, 0.1, radius, center);
}

TEST(MeshCheck, IsCleanForOneBodyAndForBodiesApart) {
  for (const Mesh& mesh :
       {ball(1.0), turned(shapes::box({0.3, 0.5, 0.7})), joined({ball(1.0), ball(0.5, {2, 0, 0})})}) {
    const MeshCheck check = check_mesh(mesh);
    EXPECT_TRUE(check.clean());
    EXPECT_EQ(check.undecided + check.open_shells, 0u);
    EXPECT_EQ(check.shells, mesh.topology().components);
    EXPECT_THAT(check.contacts.touched, ::testing::Each(0));
  }
}

TEST(MeshCheck, IsCleanForEveryRecipe) {
  for (const Recipe& recipe : recipes()) {
    for (const std::size_t triangles : {recipe.minimum, std::size_t{3000}}) {
      EXPECT_TRUE(check_mesh(recipe.make(triangles)).clean()) << recipe.name << ' ' << triangles;
    }
  }
}

TEST(MeshCheck, FindsADoubledShell) {
  const Mesh one = turned(ball(1.0));
  const MeshCheck check = check_mesh(joined({one, one}));
  EXPECT_EQ(check.contacts.coincident, one.triangles().size());
  EXPECT_EQ(check.contacts.pairs(), check.contacts.coincident);
  EXPECT_EQ(check.shells, 2u);
  EXPECT_EQ(check.doubled, 1u);
  EXPECT_EQ(check.meeting, 0u);
  ASSERT_EQ(check.first.size(), 1u);
  EXPECT_EQ(check.first[0].defect, ShellDefect::doubled);
  EXPECT_EQ(check.first[0].triangle, one.triangles().size());
  EXPECT_EQ(check.first[0].triangles, one.triangles().size());
  EXPECT_FALSE(check.clean());
}

TEST(MeshCheck, CountsTheLayersOfNestedShells) {
  const MeshCheck check = check_mesh(turned(joined({ball(1.0), ball(0.7), ball(0.4)})));
  EXPECT_EQ(check.contacts.pairs(), 0u);
  EXPECT_EQ(check.nested, 2u);
  ASSERT_EQ(check.first.size(), 2u);
  EXPECT_EQ(check.first[0].layers, 2);
  EXPECT_EQ(check.first[1].layers, 3);
}

TEST(MeshCheck, AcceptsACavityAndABodyInIt) {
  const Mesh mesh = turned(joined({ball(1.0), inside_out(ball(0.7)), ball(0.4)}));
  const MeshCheck check = check_mesh(mesh);
  EXPECT_TRUE(check.clean());
  EXPECT_EQ(check.shells, 3u);
}

TEST(MeshCheck, FindsShellsThatFaceInwardsInEmptySpace) {
  const MeshCheck check = check_mesh(turned(joined({ball(1.0), inside_out(ball(0.5, {2, 0, 0}))})));
  EXPECT_EQ(check.inverted, 1u);
  EXPECT_EQ(check.nested, 0u);
  ASSERT_EQ(check.first.size(), 1u);
  EXPECT_EQ(check.first[0].layers, -1);
}

/// A body and another that pierces it: the curve where they cross is closed, and every crossing triangle is named.
TEST(MeshCheck, FindsCrossingBodies) {
  const Mesh block = shapes::box({1.0, 0.8, 0.6});
  const Mesh needle = shapes::box({0.1, 0.1, 2.0}, {0.23, 0.11, 0.0});
  const MeshCheck check = check_mesh(turned(joined({block, needle})));
  // The four sides of the needle (8 triangles) pass through the top and through the bottom. The diagonals of those two
  // faces run from (-1, -0.8) to (1, 0.8) or across: the needle's section lies in one or two triangles.
  EXPECT_GE(check.contacts.crossing, 16u);
  EXPECT_EQ(check.contacts.coplanar + check.contacts.coincident, 0u);
  EXPECT_EQ(check.meeting, 2u);
  EXPECT_EQ(check.nested, 0u);
  for (const SelfContact& contact : check.contacts.first) {
    EXPECT_LT(contact.a, 12u);
    EXPECT_GE(contact.b, 12u);
  }
  for (std::size_t t = 0; t < 4; ++t) EXPECT_EQ(check.contacts.touched[12 + t], 0) << "end of the needle";
}

TEST(MeshCheck, FindsFacesThatLieOnEachOther) {
  // The small box stands on top of the large one; its bottom is part of the top.
  const Mesh pair = joined({shapes::box({1.0, 1.0, 1.0}), shapes::box({0.3, 0.4, 0.5}, {0.1, -0.2, 1.5})});
  const MeshCheck check = check_mesh(pair);
  EXPECT_GT(check.contacts.coplanar, 0u);
  EXPECT_GT(check.contacts.crossing, 0u);  // sides of the small box end on the top
  EXPECT_EQ(check.meeting, 2u);
  EXPECT_EQ(check.nested + check.inverted + check.undecided, 0u);
}

TEST(MeshCheck, PlacesLieOnBothTriangles) {
  shapes::Generator generator(7);
  const Mesh soup = shapes::soup(generator, 200, 1.0, 0.6);
  const MeshCheck check = check_mesh(soup);
  ASSERT_EQ(check.contacts.first.size(), SelfContacts::k_listed);
  EXPECT_EQ(check.open_shells, 200u);
  for (const SelfContact& contact : check.contacts.first) {
    for (const std::uint32_t t : {contact.a, contact.b}) {
      const auto corner = [&](std::size_t k) { return soup.vertices()[soup.triangles()[t][k]]; };
      const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
      EXPECT_NEAR(normal.dot(contact.point - corner(0)), 0.0, k_plane_rounding);
    }
  }
}

TEST(MeshCheck, IsTheSameForEveryNumberOfThreads) {
  shapes::Generator generator(11);
  const Mesh soup = shapes::soup(generator, 3000, 1.0, 0.2);
  RunOptions one;
  one.threads = 1;
  const MeshCheck a = check_mesh(soup, one), b = check_mesh(soup);
  EXPECT_GT(a.contacts.crossing, 1000u);
  EXPECT_EQ(a.contacts.crossing, b.contacts.crossing);
  EXPECT_EQ(a.contacts.touched, b.contacts.touched);
  ASSERT_EQ(a.contacts.first.size(), b.contacts.first.size());
  for (std::size_t i = 0; i < a.contacts.first.size(); ++i) {
    EXPECT_EQ(a.contacts.first[i].a, b.contacts.first[i].a);
    EXPECT_EQ(a.contacts.first[i].b, b.contacts.first[i].b);
    EXPECT_EQ(a.contacts.first[i].point, b.contacts.first[i].point);
  }
}

TEST(MeshCheck, EndsWhenItIsCancelled) {
  RunOptions options;
  options.cancelled = [] { return true; };
  EXPECT_THROW(check_mesh(ball(1.0), options), Interrupted);
}

}  // namespace
}  // namespace sixdof
