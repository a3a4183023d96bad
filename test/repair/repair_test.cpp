#include <sixdof/repair/repair.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "damage.h"

/// Damage of one kind each, with the counts that the log must have.
namespace sixdof {
namespace {

using damage::Soup;

constexpr double k_rounding = 1e-12;  // of a volume of order 1, summed over some thousand triangles

Mesh ball() { return shapes::bumpy_sphere(3, 0.2); }

std::size_t count(const RepairedMesh& repaired, RepairKind kind) { return repaired.log.of(kind).count; }

/// A second repair finds nothing and gives the same bits.
void expect_idempotent(const RepairedMesh& once, const RepairOptions& options = {}) {
  EXPECT_TRUE(once.converged);
  const RepairedMesh twice = repair_mesh(once.mesh, options);
  EXPECT_EQ(twice.log.total(), 0u);
  EXPECT_EQ(twice.mesh.hash(), once.mesh.hash());
  EXPECT_EQ(twice.passes, 1u);
}

void expect_like(const RepairedMesh& repaired, const Mesh& original, double tolerance) {
  EXPECT_TRUE(repaired.mesh.solid()) << repaired.mesh.why_not_solid();
  EXPECT_TRUE(repaired.mesh.topology().manifold);
  EXPECT_NEAR(repaired.mesh.volume(), original.volume(), tolerance);
  EXPECT_TRUE(repaired.mesh.repairs().zero_area_triangles.empty());
  expect_idempotent(repaired);
}

Mesh joined(const Mesh& a, const Mesh& b) {
  Soup soup(a);
  const auto n = static_cast<std::uint32_t>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(), b.vertices().begin(), b.vertices().end());
  for (const Triangle& t : b.triangles()) soup.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return soup.build();
}

Mesh inside_out(const Mesh& mesh) {
  Soup soup(mesh);
  for (Triangle& t : soup.triangles) std::swap(t[1], t[2]);
  return soup.build();
}

TEST(Repair, LeavesSoundMeshesAsTheyAre) {
  shapes::Generator generator(3);
  const Mesh cavity = joined(ball(), inside_out(shapes::bumpy_sphere(2, 0.1, 0.4)));
  const Mesh nested = joined(ball(), shapes::bumpy_sphere(2, 0.1, 0.4));
  for (const Mesh& mesh : {ball(), shapes::box({0.3, 0.4, 0.5}), cavity, nested,
                           shapes::moved(cavity, shapes::random_pose(generator, 3.0))}) {
    const RepairedMesh repaired = repair_mesh(mesh);
    EXPECT_EQ(repaired.mesh.hash(), mesh.hash());
    EXPECT_EQ(repaired.log.total(), 0u);
    EXPECT_TRUE(repaired.converged);
  }
}

TEST(Repair, TurnsTriangles) {
  const Mesh mesh = ball();
  Soup soup(mesh);
  for (const std::size_t t : {5u, 6u, 100u, 700u}) std::swap(soup.triangles[t][0], soup.triangles[t][2]);
  const RepairedMesh repaired = repair_mesh(soup.build());
  EXPECT_EQ(count(repaired, RepairKind::flipped_triangles), 4u);
  EXPECT_EQ(repaired.log.total(), 4u);
  EXPECT_EQ(repaired.log.of(RepairKind::flipped_triangles).first.size(), 4u);
  expect_like(repaired, mesh, k_rounding);
}

TEST(Repair, TurnsASolidWithACavityAsAWhole) {
  const Mesh cavity = joined(ball(), inside_out(shapes::bumpy_sphere(2, 0.1, 0.4)));
  const RepairedMesh repaired = repair_mesh(inside_out(cavity));
  EXPECT_EQ(count(repaired, RepairKind::flipped_triangles), cavity.triangles().size());
  expect_like(repaired, cavity, k_rounding);
}

TEST(Repair, LeavesAMoebiusStripAsItIs) {
  std::vector<Eigen::Vector3d> v;
  std::vector<Triangle> t;
  constexpr std::uint32_t k_steps = 12;
  for (std::uint32_t i = 0; i < k_steps; ++i) {
    const double u = 2.0 * std::numbers::pi * i / k_steps;
    for (const double w : {-0.3, 0.3}) {
      const double r = 1.0 + w * std::cos(0.5 * u);
      v.emplace_back(r * std::cos(u), r * std::sin(u), w * std::sin(0.5 * u));
    }
    const bool last = i + 1 == k_steps;
    const std::uint32_t a = 2 * i, b = 2 * i + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    t.push_back({a, b, c});
    t.push_back({c, b, d});
  }
  const Mesh strip = Mesh::build(v, t, "strip");
  const RepairedMesh repaired = repair_mesh(strip, {.max_hole = 0});
  EXPECT_EQ(repaired.mesh.hash(), strip.hash());
  EXPECT_FALSE(repaired.mesh.topology().oriented);
}

TEST(Repair, DropsDuplicates) {
  const Mesh mesh = ball();
  Soup soup(mesh);
  const auto original = soup.triangles;
  soup.triangles.push_back({original[7][1], original[7][2], original[7][0]});
  soup.triangles.push_back(original[7]);
  soup.triangles.push_back({original[90][1], original[90][0], original[90][2]});
  const RepairedMesh repaired = repair_mesh(soup.build());
  EXPECT_EQ(count(repaired, RepairKind::duplicate_triangles), 3u);
  EXPECT_EQ(repaired.log.total(), 3u);
  EXPECT_EQ(repaired.mesh.hash(), mesh.hash());
}

TEST(Repair, DropsADoubledShell) {
  const Mesh mesh = ball();
  Soup soup(mesh);
  const auto original = soup.triangles;
  soup.triangles.insert(soup.triangles.end(), original.begin(), original.end());
  const RepairedMesh repaired = repair_mesh(soup.build());
  EXPECT_EQ(count(repaired, RepairKind::duplicate_triangles), original.size());
  EXPECT_EQ(repaired.mesh.hash(), mesh.hash());
}

/// Two boxes on each other: the wall between them belongs to both.
TEST(Repair, KeepsAWallBetweenTwoBodies) {
  const Mesh low = shapes::box({0.5, 0.5, 0.5}), high = shapes::box({0.5, 0.5, 0.5}, {0, 0, 1});
  const Mesh both = joined(low, high);
  ASSERT_EQ(both.vertices().size(), 12u);
  EXPECT_EQ(repair_mesh(both).mesh.hash(), both.hash());
}

TEST(Repair, WeldsSplitVertices) {
  const Mesh mesh = ball();
  const double tolerance = RepairOptions::k_default_weld * mesh.diagonal();
  // Every corner has a vertex of its own.
  shapes::Generator generator(5);
  Soup soup(mesh);
  for (Triangle& t : soup.triangles) {
    for (std::uint32_t& v : t)
      v = damage::add(soup, mesh.vertices()[v] + shapes::uniform_vector(generator, 0.2 * tolerance));
  }
  const RepairedMesh repaired = repair_mesh(soup.build());
  EXPECT_EQ(repaired.mesh.vertices().size(), mesh.vertices().size());
  EXPECT_EQ(repaired.mesh.triangles().size(), mesh.triangles().size());
  EXPECT_EQ(count(repaired, RepairKind::welded_vertices), 3 * mesh.triangles().size() - mesh.vertices().size());
  expect_like(repaired, mesh, tolerance * mesh.area());
  // Not farther than asked for.
  EXPECT_EQ(count(repair_mesh(soup.build(), {.weld = 0.0, .max_hole = 0}), RepairKind::welded_vertices), 0u);
}

TEST(Repair, WeldsNoInnerVertices) {
  const Mesh near = joined(shapes::box({0.5, 0.5, 0.5}), shapes::box({0.5, 0.5, 0.5}, {1.0 + 1e-8, 0, 0}));
  EXPECT_EQ(repair_mesh(near, {.weld = 1e-3}).mesh.hash(), near.hash());
}

TEST(Repair, FillsHolesOfFewEdges) {
  const Mesh mesh = ball();
  Soup soup(mesh);
  soup.triangles.erase(soup.triangles.begin() + 200);
  soup.triangles.erase(soup.triangles.begin() + 20);
  const RepairedMesh repaired = repair_mesh(soup.build());
  EXPECT_EQ(count(repaired, RepairKind::filled_holes), 2u);
  expect_like(repaired, mesh, k_rounding);
  const RepairedMesh open = repair_mesh(soup.build(), {.max_hole = 0});
  EXPECT_EQ(open.mesh.topology().border_edges, 6u);
  EXPECT_EQ(open.log.total(), 0u);
}

/// All triangles at one vertex: the hole has as many edges, and is filled flat.
TEST(Repair, FillsAHoleAroundAVertexUpToTheStatedSize) {
  const Mesh mesh = shapes::bumpy_sphere(3, 0.0);
  Soup soup(mesh);
  std::erase_if(soup.triangles, [](const Triangle& t) { return t[0] == 50 || t[1] == 50 || t[2] == 50; });
  const std::size_t edges = mesh.triangles().size() - soup.triangles.size();
  ASSERT_EQ(edges, 6u);
  EXPECT_EQ(count(repair_mesh(soup.build(), {.max_hole = edges - 1}), RepairKind::filled_holes), 0u);
  const RepairedMesh repaired = repair_mesh(soup.build(), {.max_hole = edges});
  EXPECT_EQ(count(repaired, RepairKind::filled_holes), 1u);
  EXPECT_EQ(repaired.mesh.triangles().size(), mesh.triangles().size() - 2);
  // Missing: a cap of height e^2 / 2 over a hexagon of edge e, about 0.14.
  expect_like(repaired, mesh, 0.14 * 0.14 * 0.5 * 2.6 * 0.14 * 0.14);
}

TEST(Repair, DoesNotTakeTheBorderOfASheetForAHole) {
  std::vector<Eigen::Vector3d> v;
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (std::uint32_t j = 0; j < 4; ++j) {
      v.emplace_back(i, j, 0.01 * i * j);
      if (i == 3 || j == 3) continue;
      const std::uint32_t a = 4 * i + j;
      t.push_back({a, a + 4, a + 5});
      t.push_back({a, a + 5, a + 1});
    }
  }
  for (const Mesh& sheet :
       {Mesh::build(v, t, "sheet"), Mesh::build(v, {t[0]}, "triangle"), Mesh::build(v, {t[0], t[1]}, "quad")}) {
    const RepairedMesh repaired = repair_mesh(sheet);
    EXPECT_EQ(repaired.mesh.hash(), sheet.hash());
  }
}

/// Two holes that touch in a vertex are two holes.
TEST(Repair, FillsHolesThatTouch) {
  const Mesh mesh = ball();
  std::vector<std::uint32_t> around;
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    const Triangle& t = mesh.triangles()[i];
    if (std::find(t.begin(), t.end(), 50) != t.end()) around.push_back(i);
  }
  ASSERT_EQ(around.size(), 6u);
  const auto shares_edge = [&](std::uint32_t a, std::uint32_t b) {
    std::size_t shared = 0;
    for (const std::uint32_t v : mesh.triangles()[a]) {
      shared += static_cast<std::size_t>(std::count(mesh.triangles()[b].begin(), mesh.triangles()[b].end(), v));
    }
    return shared == 2;
  };
  // Every other triangle of the fan.
  std::vector<std::uint32_t> apart;
  for (const std::uint32_t i : around) {
    if (std::none_of(apart.begin(), apart.end(), [&](std::uint32_t j) { return shares_edge(i, j); }))
      apart.push_back(i);
  }
  ASSERT_GE(apart.size(), 2u);
  Soup soup(mesh);
  std::sort(apart.rbegin(), apart.rend());
  for (const std::uint32_t i : apart) soup.triangles.erase(soup.triangles.begin() + i);
  const RepairedMesh repaired = repair_mesh(soup.build());
  EXPECT_EQ(count(repaired, RepairKind::filled_holes), apart.size());
  expect_like(repaired, mesh, k_rounding);
}

TEST(Repair, ClosesTJunctions) {
  const Mesh mesh = ball();
  const double tolerance = RepairOptions::k_default_weld * mesh.diagonal();
  shapes::Generator generator(9);
  for (const double noise : {0.0, 0.3 * tolerance}) {
    Soup soup(mesh);
    damage::make_t_junctions(soup, generator, 20, noise);
    const Mesh damaged = soup.build();
    ASSERT_EQ(damaged.topology().border_edges, 60u);
    const RepairedMesh repaired = repair_mesh(damaged);
    EXPECT_EQ(count(repaired, RepairKind::split_edges), 20u);
    EXPECT_EQ(repaired.log.total(), 20u);
    EXPECT_EQ(repaired.mesh.triangles().size(), mesh.triangles().size() + 40);
    expect_like(repaired, mesh, tolerance * mesh.area());
  }
}

/// Both sides have vertices that the other lacks: two boxes' worth of halves that meet in one line.
TEST(Repair, ClosesTJunctionsOnBothSidesOfALine) {
  Soup soup(shapes::box({1, 1, 1}));
  const auto find = [&](double x, double y, double z) {
    const Eigen::Vector3d p(x, y, z);
    return static_cast<std::uint32_t>(std::find(soup.vertices.begin(), soup.vertices.end(), p) - soup.vertices.begin());
  };
  const std::uint32_t a = find(-1, -1, 1), b = find(1, -1, 1);
  for (Triangle& t : std::vector<Triangle>(soup.triangles)) {
    for (std::size_t k = 0; k < 3; ++k) {
      const bool up = t[k] == a && t[(k + 1) % 3] == b, down = t[k] == b && t[(k + 1) % 3] == a;
      if (!up && !down) continue;
      const std::uint32_t m = damage::add(soup, {up ? 0.3 : -0.4, -1, 1});
      const std::uint32_t apex = t[(k + 2) % 3], from = t[k], to = t[(k + 1) % 3];
      std::erase(soup.triangles, t);
      soup.triangles.push_back({from, m, apex});
      soup.triangles.push_back({m, to, apex});
    }
  }
  ASSERT_EQ(soup.triangles.size(), 14u);
  const RepairedMesh repaired = repair_mesh(soup.build());
  EXPECT_EQ(count(repaired, RepairKind::split_edges), 2u);
  EXPECT_NEAR(repaired.mesh.volume(), 8.0, k_rounding);
  EXPECT_TRUE(repaired.mesh.solid());
  expect_idempotent(repaired);
}

TEST(Repair, TakesOutTrianglesWithoutArea) {
  const Mesh mesh = ball();
  shapes::Generator generator(13);
  Soup soup(mesh);
  damage::add_flat_triangles(soup, generator, 15);
  const RepairedMesh repaired = repair_mesh(soup.build());
  EXPECT_EQ(count(repaired, RepairKind::degenerate_triangles), 15u);
  EXPECT_EQ(repaired.log.total(), 15u);
  EXPECT_EQ(repaired.mesh.triangles().size(), mesh.triangles().size() + 30);
  expect_like(repaired, mesh, k_rounding);
}

TEST(Repair, RefusesOptionsOutOfRange) {
  for (const double weld : {-1e-9, 0.2, std::nan("")}) {
    EXPECT_THROW(repair_mesh(ball(), {.weld = weld}), BadArgument) << weld;
  }
  EXPECT_THROW(repair_mesh(ball(), {.max_hole = RepairOptions::k_largest_max_hole + 1}), BadArgument);
}

}  // namespace
}  // namespace sixdof
