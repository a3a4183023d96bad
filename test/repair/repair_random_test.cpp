#include <gtest/gtest.h>

#include <sixdof/repair/repair.h>

#include "damage.h"

/// Damage of all kinds at once, at random places.
namespace sixdof {
namespace {

using damage::Soup;

constexpr int k_seeds = 300;

Mesh original_of(int seed) {
  shapes::Generator generator(static_cast<std::uint64_t>(seed) + 1000);
  const Mesh mesh = seed % 3 == 0 ? shapes::box({0.9, 0.8, 0.7}) : shapes::bumpy_sphere(2 + seed % 2, 0.2);
  return shapes::moved(mesh, shapes::random_pose(generator, 0.5));
}

struct Kinds {
  bool holes, other;
};

Mesh damaged(const Mesh& mesh, shapes::Generator& generator, Kinds kinds) {
  const double tolerance = RepairOptions::k_default_weld * mesh.diagonal();
  const std::size_t few = 1 + mesh.triangles().size() / 100;
  Soup soup(mesh);
  if (kinds.other) {
    damage::add_flat_triangles(soup, generator, damage::pick(generator, few + 1));
    damage::make_t_junctions(soup, generator, damage::pick(generator, few + 1), 0.1 * tolerance);
    damage::duplicate(soup, generator, damage::pick(generator, few + 1));
    damage::split_vertices(soup, generator, damage::pick(generator, 2 * few + 1), 0.1 * tolerance);
  }
  if (kinds.holes) damage::remove(soup, generator, damage::pick(generator, few + 1));
  damage::flip(soup, generator, damage::pick(generator, mesh.triangles().size() / 4));
  return soup.build();
}

void expect_idempotent(const RepairedMesh& once, int seed) {
  EXPECT_TRUE(once.converged) << seed;
  const RepairedMesh twice = repair_mesh(once.mesh);
  EXPECT_EQ(twice.log.total(), 0u) << seed;
  EXPECT_EQ(twice.mesh.hash(), once.mesh.hash()) << seed;
}

/// Without missing triangles the shape comes back, to the tolerance of welding.
TEST(RepairAtRandom, GivesBackTheShapeWhereNothingIsMissing) {
  for (int seed = 0; seed < k_seeds; ++seed) {
    shapes::Generator generator(static_cast<std::uint64_t>(seed));
    const Mesh mesh = original_of(seed);
    const RepairedMesh repaired = repair_mesh(damaged(mesh, generator, {.holes = false, .other = true}));
    EXPECT_TRUE(repaired.mesh.solid()) << seed << ": " << repaired.mesh.why_not_solid();
    EXPECT_NEAR(repaired.mesh.volume(), mesh.volume(), RepairOptions::k_default_weld * mesh.diagonal() * mesh.area())
        << seed;
    EXPECT_TRUE(repaired.mesh.repairs().zero_area_triangles.empty()) << seed;
    expect_idempotent(repaired, seed);
  }
}

/// A filled hole differs from what was there by less than a body as wide as the missing triangles.
TEST(RepairAtRandom, FillsHoles) {
  for (int seed = 0; seed < k_seeds; ++seed) {
    if (seed % 3 == 0) continue;  // two of a box's twelve triangles are much of it
    shapes::Generator generator(static_cast<std::uint64_t>(seed));
    const Mesh mesh = original_of(seed);
    const Mesh broken = damaged(mesh, generator, {.holes = true, .other = false});
    const RepairedMesh repaired = repair_mesh(broken);
    EXPECT_TRUE(repaired.mesh.solid()) << seed << ": " << repaired.mesh.why_not_solid();
    const double missing = mesh.area() - broken.area();
    EXPECT_NEAR(repaired.mesh.volume(), mesh.volume(), 0.3 * std::pow(missing, 1.5) + 1e-12) << seed;
    expect_idempotent(repaired, seed);
  }
}

/// All at once: a vertex of a T-junction may stand at a hole, and duplicates at split vertices. Every repair ends, and
/// a second one has nothing to do.
TEST(RepairAtRandom, IsIdempotentForAllDamagesTogether) {
  std::size_t solid = 0;
  for (int seed = 0; seed < k_seeds; ++seed) {
    shapes::Generator generator(static_cast<std::uint64_t>(seed));
    const RepairedMesh repaired = repair_mesh(damaged(original_of(seed), generator, {.holes = true, .other = true}));
    solid += repaired.mesh.solid() ? 1 : 0;
    expect_idempotent(repaired, seed);
  }
  EXPECT_GE(solid, static_cast<std::size_t>(0.95 * k_seeds));
}

/// Triangles that have nothing to do with each other.
TEST(RepairAtRandom, IsIdempotentForSoups) {
  for (int seed = 0; seed < 50; ++seed) {
    shapes::Generator generator(static_cast<std::uint64_t>(seed));
    Soup soup(shapes::soup(generator, 60, 1.0, 0.5));
    // Coordinates on a coarse grid: shared vertices, collinear corners, vertices on edges.
    for (Eigen::Vector3d& p : soup.vertices) p = (4.0 * p).array().round().matrix() / 4.0;
    expect_idempotent(repair_mesh(soup.build()), seed);
  }
}

}  // namespace
}  // namespace sixdof
