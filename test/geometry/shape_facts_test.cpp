#include <sixdof/geometry/shape_facts.h>

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-12;  // of sums over some hundred triangles

/// A box with its edges along the axes and every face divided into n x n squares of two triangles each.
Mesh divided_box(const Eigen::Vector3d& size, int n) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, 1.0}) {
      const auto point = [&](int i, int j) {
        Eigen::Vector3d p;
        p[axis] = side;
        p[(axis + 1) % 3] = static_cast<double>(i) / n;
        p[(axis + 2) % 3] = static_cast<double>(j) / n;
        return Eigen::Vector3d(p.cwiseProduct(size));
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto first = static_cast<std::uint32_t>(vertices.size());
          for (const auto& [di, dj] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
            vertices.push_back(point(i + di, j + dj));
          }
          for (Triangle t : {Triangle{first, first + 1, first + 2}, Triangle{first, first + 2, first + 3}}) {
            if (side == 0.0) std::swap(t[1], t[2]);
            triangles.push_back(t);
          }
        }
      }
    }
  }
  return Mesh::build(std::move(vertices), std::move(triangles), "box");
}

Mesh moved(const Mesh& mesh, const Eigen::Matrix3d& rotation, double factor) {
  std::vector<Eigen::Vector3d> vertices = mesh.vertices();
  for (Eigen::Vector3d& p : vertices) p = factor * (rotation * p) + Eigen::Vector3d(3, -1, 2);
  return Mesh::build(std::move(vertices), mesh.triangles());
}

TEST(ShapeFacts, OfABoxAreItsClosedForm) {
  constexpr int n = 4;
  const Mesh box = divided_box({2.0, 1.0, 0.5}, n);
  ASSERT_TRUE(box.solid()) << box.why_not_solid();
  const ShapeFacts facts = shape_facts(box);
  EXPECT_EQ(facts.genus, 0);
  EXPECT_DOUBLE_EQ(facts.box_aspect, 0.25);
  EXPECT_NEAR(facts.box_fill, 1.0, k_rounding);
  EXPECT_NEAR(facts.thickness, 2.0 * 1.0 / 7.0 / std::sqrt(5.25), k_rounding);
  EXPECT_NEAR(facts.aligned_share, 1.0, k_rounding);
  // Of 18 n^2 edges the 12 n on the box's own edges bend.
  EXPECT_NEAR(facts.flat_share, 1.0 - 12.0 * n / (18.0 * n * n), k_rounding);
}

TEST(ShapeFacts, DoNotDependOnTheUnitAndOnlyTheFramesOnesOnTheFrame) {
  const Mesh box = divided_box({2.0, 1.0, 0.5}, 5);
  const ShapeFacts facts = shape_facts(box), larger = shape_facts(moved(box, Eigen::Matrix3d::Identity(), 1234.5));
  EXPECT_NEAR(larger.thickness, facts.thickness, k_rounding);
  EXPECT_NEAR(larger.box_fill, facts.box_fill, k_rounding);
  EXPECT_NEAR(larger.flat_share, facts.flat_share, k_rounding);
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const ShapeFacts turned = shape_facts(moved(box, rotation, 1.0));
  EXPECT_EQ(turned.aligned_share, 0.0);
  EXPECT_NEAR(turned.flat_share, facts.flat_share, k_rounding);
}

TEST(ShapeFacts, AnOpenMeshHasNoVolumeAndNoGenus) {
  const Mesh square = Mesh::build({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const ShapeFacts facts = shape_facts(square);
  EXPECT_EQ(facts.genus, 0);
  EXPECT_EQ(facts.box_fill, 0.0);
  EXPECT_EQ(facts.thickness, 0.0);
  EXPECT_EQ(facts.flat_share, 1.0);
}

TEST(ShapeKind, EachHasItsCondition) {
  EXPECT_EQ(kind_of({.genus = 10, .thickness = 0.001}), ShapeKind::handles);
  EXPECT_EQ(kind_of({.genus = 9, .box_aspect = 1, .thickness = 0.019}), ShapeKind::thin);
  EXPECT_EQ(kind_of({.box_aspect = 0.03}), ShapeKind::thin);
  EXPECT_EQ(kind_of({.box_aspect = 1, .aligned_share = 0.8}), ShapeKind::boxy);
  EXPECT_EQ(kind_of({.box_aspect = 1, .thickness = 0.1, .flat_share = 0.25}), ShapeKind::cad);
  EXPECT_EQ(kind_of({.box_aspect = 1, .thickness = 0.1, .flat_share = 0.2}), ShapeKind::organic);
  EXPECT_EQ(name_of(ShapeKind::handles), "handles");
}

}  // namespace
}  // namespace sixdof
