#include <sixdof/oracle/triangle_contact.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

/// In all orders of corners and both orders of the triangles.
void expect_contact(const std::vector<Eigen::Vector3d>& points, Triangle a, Triangle b,
                    std::optional<ContactKind> expected) {
  std::sort(a.begin(), a.end());
  do {
    std::sort(b.begin(), b.end());
    do {
      for (const auto& [x, y] : {std::pair(a, b), std::pair(b, a)}) {
        const auto contact = find_contact(points, x, y);
        ASSERT_EQ(contact.has_value(), expected.has_value());
        if (contact) {
          ASSERT_EQ(contact->kind, *expected);
        }
      }
    } while (std::next_permutation(b.begin(), b.end()));
  } while (std::next_permutation(a.begin(), a.end()));
}

TEST(TriangleContact, OfTrianglesThatShareAVertex) {
  // b's opposite edge: pierces a, ends on a, lies in a's plane inside and outside of a, is apart.
  const std::vector<Eigen::Vector3d> p{{0, 0, 0}, {4, 0, 0}, {0, 4, 0},  {1, 1, -1},  {1, 1, 1}, {1, 1, 0}, {3, 1, 1},
                                       {5, 5, 0}, {6, 5, 0}, {-1, 1, 0}, {-1, -2, 0}, {2, 2, 0}, {1, 0, 3}, {0, 1, 3}};
  expect_contact(p, {0, 1, 2}, {0, 3, 4}, ContactKind::crossing);
  expect_contact(p, {0, 1, 2}, {0, 5, 6}, ContactKind::crossing);
  expect_contact(p, {0, 1, 2}, {0, 7, 8}, ContactKind::coplanar);
  expect_contact(p, {0, 1, 2}, {0, 9, 10}, std::nullopt);
  expect_contact(p, {0, 1, 2}, {0, 12, 13}, std::nullopt);
  expect_contact(p, {0, 1, 2}, {0, 11, 9}, ContactKind::coplanar);
}

TEST(TriangleContact, OfTrianglesThatShareAnEdge) {
  const std::vector<Eigen::Vector3d> p{{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {2, -1, 0}, {2, 1, 0}, {2, 1, 0x1p-60}};
  expect_contact(p, {0, 1, 2}, {0, 1, 3}, std::nullopt);
  expect_contact(p, {0, 1, 2}, {0, 1, 4}, ContactKind::coplanar);
  expect_contact(p, {0, 1, 2}, {0, 1, 5}, std::nullopt);  // folded back, but not quite
  expect_contact(p, {0, 1, 2}, {2, 0, 1}, ContactKind::coincident);
}

TEST(TriangleContact, OfTrianglesThatShareNothing) {
  const std::vector<Eigen::Vector3d> p{{0, 0, 0},       {4, 0, 0},  {0, 4, 0},   // a
                                       {1, 1, 0},       {1, 1, 2},  {2, 1, 2},   // a corner on a
                                       {2, 2, -1},      {2, 2, 1},  {5, 5, 0},   // an edge through a's longest edge
                                       {1, 1, 0},       {2, 1, 0},  {1, 2, 0},   // inside a
                                       {3, 3, 0},       {5, 3, 0},  {3, 5, 0},   // in its plane, beside it
                                       {1, 1, 0x1p-70}, {1, 1, 2},  {2, 1, 2},   // not quite on a
                                       {4, 0, 1},       {4, 0, -1}, {6, 0, 0}};  // an edge through a's corner
  expect_contact(p, {0, 1, 2}, {3, 4, 5}, ContactKind::crossing);
  expect_contact(p, {0, 1, 2}, {6, 7, 8}, ContactKind::crossing);
  expect_contact(p, {0, 1, 2}, {9, 10, 11}, ContactKind::coplanar);
  expect_contact(p, {0, 1, 2}, {12, 13, 14}, std::nullopt);
  expect_contact(p, {0, 1, 2}, {15, 16, 17}, std::nullopt);
  expect_contact(p, {0, 1, 2}, {18, 19, 20}, ContactKind::crossing);
}

TEST(TriangleContact, CollinearCorners) {
  EXPECT_TRUE(is_collinear({0, 0, 0}, {1, 2, 3}, {2, 4, 6}));
  EXPECT_TRUE(is_collinear({0, 0, 0}, {1, 2, 3}, {1, 2, 3}));
  EXPECT_FALSE(is_collinear({0, 0, 0}, {1, 2, 3}, {2, 4, std::nextafter(6.0, 7.0)}));
}

}  // namespace
}  // namespace sixdof
