#include <random>

#include <cgal_overlap.h>
#include <gtest/gtest.h>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/self_contacts.h>

#include "../geometry/shapes.h"

/// The number of pairs of triangles in contact, against CGAL's exact predicates and its own search.
namespace sixdof {
namespace {

std::size_t contacts(const Mesh& mesh) { return find_self_contacts(mesh, Tree(mesh)).pairs(); }

std::size_t by_cgal(const Mesh& mesh) { return reference::count_self_intersections(reference::to_cgal(mesh)); }

bool has_collinear_triangle(const Mesh& mesh) {
  return std::any_of(mesh.triangles().begin(), mesh.triangles().end(), [&](const Triangle& t) {
    return is_collinear(mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]);
  });
}

/// A sphere whose vertices are moved at random by up to `noise`, in a random pose; coordinates are multiples of `step`
/// where that is not zero. Vertices stay apart, as CGAL needs it.
Mesh crumpled(shapes::Generator& generator, int levels, double noise, double step) {
  const Mesh sphere = shapes::bumpy_sphere(levels, 0.2);
  const Pose pose = shapes::random_pose(generator, 0.5);
  std::vector<Eigen::Vector3d> vertices;
  for (const Eigen::Vector3d& p : sphere.vertices()) {
    Eigen::Vector3d q = pose * (p + shapes::uniform_vector(generator, noise));
    if (step > 0.0) q = step * (q / step).array().round().matrix();
    vertices.push_back(q);
  }
  return Mesh::build(std::move(vertices), sphere.triangles(), "crumpled");
}

TEST(SelfContactsAgainstCgal, OfCrumpledSpheres) {
  shapes::Generator generator(1);
  std::size_t in_all = 0;
  for (int i = 0; i < 40; ++i) {
    const Mesh mesh = crumpled(generator, 2 + i % 3, 0.01 * static_cast<double>(1 << (i % 6)), 0.0);
    const std::size_t found = contacts(mesh);
    EXPECT_EQ(found, by_cgal(mesh)) << i;
    in_all += found;
  }
  EXPECT_GT(in_all, 10'000u);
}

/// Coordinates on a coarse grid: many triangles in one plane, vertices on edges and faces of others.
TEST(SelfContactsAgainstCgal, OnAGrid) {
  shapes::Generator generator(2);
  std::size_t tried = 0, coplanar = 0;
  for (int i = 0; i < 400 && tried < 60; ++i) {
    const Mesh mesh = crumpled(generator, 1 + i % 2, 0.3, 0x1p-4);
    // CGAL counts collinear triangles; welded vertices may leave a mesh that is no manifold, which it does not take.
    if (has_collinear_triangle(mesh) || !mesh.topology().manifold || mesh.repairs().welded_vertices > 0) continue;
    ++tried;
    const SelfContacts found = find_self_contacts(mesh, Tree(mesh));
    EXPECT_EQ(found.pairs(), by_cgal(mesh)) << i;
    coplanar += found.coplanar;
  }
  EXPECT_EQ(tried, 60u);
  EXPECT_GT(coplanar, 20u);
}

}  // namespace
}  // namespace sixdof
