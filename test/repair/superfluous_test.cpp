#include <sixdof/repair/steps.h>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/repair/repair.h>

#include "damage.h"

/// Triangles that a closed surface does not need: dropped from solids, kept wherever they may be a part of the shape.
namespace sixdof {
namespace {

constexpr double k_rounding = 1e-15;  // of the volume of a unit body

using damage::Soup;
using Points = std::vector<Eigen::Vector3d>;

std::size_t count(const RepairedMesh& repaired, RepairKind kind) { return repaired.log.of(kind).count; }

/// A cube of volume 1 from the origin. Corner i has the bits of i as coordinates.
Soup cube() { return Soup(shapes::box({0.5, 0.5, 0.5}, {0.5, 0.5, 0.5})); }

std::uint32_t vertex_at(Soup& soup, const Eigen::Vector3d& p) {
  const auto found = std::find(soup.vertices.begin(), soup.vertices.end(), p);
  return found != soup.vertices.end() ? static_cast<std::uint32_t>(found - soup.vertices.begin())
                                      : damage::add(soup, p);
}

/// Adds triangles of each three successive points.
Soup with(Soup soup, const Points& corners) {
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const std::uint32_t a = vertex_at(soup, corners[i]), b = vertex_at(soup, corners[i + 1]);
    soup.triangles.push_back({a, b, vertex_at(soup, corners[i + 2])});
  }
  return soup;
}

struct Case {
  const char* name;
  Points added;  ///< To the cube, three points a triangle.
  RepairKind kind;
};

TEST(Superfluous, GoesFromACube) {
  using V = Eigen::Vector3d;
  const V o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), xy(1, 1, 0), xz(1, 0, 1), yz(0, 1, 1);
  const V quarter(0.25, 0, 0), half(0.5, 0, 0), out(0.5, -0.5, -0.5), in(0.5, 0.3, 0.4), near(0.8, -0.2, -0.2);
  const RepairKind flat = RepairKind::degenerate_triangles, fin = RepairKind::fins, wall = RepairKind::inner_walls,
                   stray = RepairKind::stray_triangles;
  // Edges of the cube are, besides its own, the diagonals x y, y z, z x and xy xz, xz yz, yz xy.
  const Case cases[] = {
      {"no area, on an edge", {o, half, x}, flat},
      {"no area, on a diagonal", {y, {0.5, 0.5, 0}, x}, flat},
      {"no area, twice at one edge", {o, half, x, o, quarter, x}, flat},
      {"no area, a chain", {o, quarter, half, o, half, x}, flat},
      {"no area, a chain of three", {o, quarter, half, o, half, {0.75, 0, 0}, o, {0.75, 0, 0}, x}, flat},
      {"a needle", {o, {0.5, 1e-9, 0}, x}, fin},
      {"a fin outside", {o, x, out}, fin},
      {"a fin outside, turned", {o, out, x}, fin},
      {"a fin inside", {o, x, in}, fin},
      {"two fins at one edge", {o, x, out, o, x, in}, fin},
      {"a fin of two triangles", {o, half + out * 0.5, out, half + out * 0.5, o, x}, fin},
      {"a fin on a fin", {o, x, out, o, out, {0.2, -0.7, -0.1}}, fin},
      {"a fin between two edges", {o, x, near, x, xy, near}, fin},
      {"a wall along diagonals", {x, y, yz, x, yz, xz}, wall},
      {"a wall along diagonals, turned", {x, yz, y, x, yz, xz}, wall},
      {"a wall of four triangles", {x, y, in, y, yz, in, yz, xz, in, xz, x, in}, wall},
      {"two walls that cross", {x, y, xz, y, yz, xz, y, z, xz, y, xz, xy}, wall},
      {"a wall that cuts off a corner", {x, y, z}, wall},
      {"two walls side by side", {x, y, z, xy, xz, yz}, wall},
      {"a stray triangle inside", {{0.4, 0.4, 0.5}, {0.6, 0.4, 0.5}, {0.5, 0.6, 0.5}}, stray},
      {"a stray triangle outside", {{2, 0, 0}, {2.2, 0, 0}, {2, 0.3, 0.1}}, stray},
      {"two stray triangles",
       {{2, 0, 0}, {2.2, 0, 0}, {2, 0.3, 0.1}, {0.4, 0.4, 0.5}, {0.6, 0.4, 0.5}, {0.5, 0.6, 0.5}},
       stray},
      {"a stray triangle at a vertex", {o, {-0.2, -0.1, 0}, {-0.1, -0.2, 0}}, stray},
      {"a large wall that hangs on nothing",
       {{0.5, 0.1, 0.1}, {0.5, 0.9, 0.1}, {0.5, 0.9, 0.9}, {0.5, 0.1, 0.1}, {0.5, 0.9, 0.9}, {0.5, 0.1, 0.9}},
       stray},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Mesh damaged = with(cube(), c.added).build();
    ASSERT_FALSE(damaged.solid());
    const RepairedMesh repaired = repair_mesh(damaged);
    EXPECT_TRUE(repaired.mesh.solid()) << repaired.mesh.why_not_solid();
    EXPECT_DOUBLE_EQ(repaired.mesh.volume(), 1.0);
    EXPECT_EQ(repaired.mesh.triangles().size(), 12u);
    EXPECT_EQ(count(repaired, c.kind), c.added.size() / 3);
    EXPECT_TRUE(repaired.converged);
    EXPECT_EQ(repair_mesh(repaired.mesh).log.total(), 0u);
  }
}

/// Damage of other kinds beside it does not matter.
TEST(Superfluous, GoesWithHolesAndTurnedTriangles) {
  Soup soup = with(cube(), {{0, 0, 0}, {1, 0, 0}, {0.5, -0.5, -0.5}, {2, 0, 0}, {2.2, 0, 0}, {2, 0.3, 0.1}});
  std::swap(soup.triangles[3][0], soup.triangles[3][1]);
  soup.triangles.erase(soup.triangles.begin() + 6);
  const RepairedMesh repaired = repair_mesh(soup.build());
  EXPECT_TRUE(repaired.mesh.solid()) << repaired.mesh.why_not_solid();
  EXPECT_DOUBLE_EQ(repaired.mesh.volume(), 1.0);
  EXPECT_EQ(count(repaired, RepairKind::fins), 1u);
  EXPECT_EQ(count(repaired, RepairKind::stray_triangles), 1u);
  EXPECT_EQ(count(repaired, RepairKind::filled_holes), 1u);
}

/// Of a bubble on a face, the face inside goes: the outline stays.
TEST(Superfluous, KeepsTheOutline) {
  using V = Eigen::Vector3d;
  const V x(1, 0, 0), xy(1, 1, 0), xz(1, 0, 1);
  for (const double tip : {1.5, 0.7}) {
    const V p(tip, 0.3, 0.3);
    const RepairedMesh repaired = repair_mesh(with(cube(), {x, xy, p, xy, xz, p, xz, x, p}).build());
    EXPECT_TRUE(repaired.mesh.solid()) << repaired.mesh.why_not_solid();
    EXPECT_NEAR(repaired.mesh.volume(), tip > 1.0 ? 1.0 + 0.5 * (tip - 1.0) / 3.0 : 1.0, k_rounding);
    EXPECT_EQ(count(repaired, RepairKind::inner_walls), tip > 1.0 ? 1u : 3u);
  }
}

/// A cavity stays where a wall reaches it.
TEST(Superfluous, KeepsCavities) {
  Soup soup = cube();
  const Mesh cavity = shapes::box({0.2, 0.2, 0.2}, {0.5, 0.5, 0.5});
  const auto first = static_cast<std::uint32_t>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(), cavity.vertices().begin(), cavity.vertices().end());
  for (const Triangle& t : cavity.triangles()) soup.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  const Mesh hollow = soup.build();
  ASSERT_TRUE(hollow.solid());
  EXPECT_EQ(repair_mesh(hollow).mesh.hash(), hollow.hash());
  // Between the edges from 0 to 1 of both, and a ring around.
  const std::uint32_t ring[] = {0, 1, 3, 2};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t a = ring[i], b = ring[(i + 1) % 4];
    soup.triangles.push_back({a, b, first + b});
    soup.triangles.push_back({a, first + b, first + a});
    const RepairedMesh repaired = repair_mesh(soup.build());
    EXPECT_EQ(repaired.mesh.hash(), hollow.hash()) << i;
    EXPECT_EQ(repaired.log.total(), 2 * (i + 1)) << i;
  }
}

/// A grid of 2 n^2 triangles in the plane z = 0.
Points sheet(int n, double size, const Eigen::Vector3d& at) {
  Points points;
  const auto p = [&](int i, int j) { return Eigen::Vector3d(at + Eigen::Vector3d(i, j, 0) * size / n); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      points.insert(points.end(), {p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j), p(i + 1, j + 1), p(i, j + 1)});
    }
  }
  return points;
}

TEST(Superfluous, LeavesWhatMayBeMeant) {
  const Soup empty(Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
  Soup nothing = empty;
  nothing.vertices.clear();
  nothing.triangles.clear();
  using V = Eigen::Vector3d;
  const V o(0, 0, 0), x(1, 0, 0);
  Points panels;
  for (int i = 0; i < 12; ++i) {
    for (const V& p : sheet(1, 0.6, V(2.0 + i, 0, 0.1 * i))) panels.push_back(p);
  }
  Points both = sheet(4, 3.0, {0, 0, 0});
  for (const V& p : sheet(1, 0.3, V(1, 1, 2))) both.push_back(p);
  Soup open_box = cube();
  open_box.triangles.resize(10);
  Soup three_sheets = with(nothing, {o, x, {0, 1, 0}, o, x, {0, -1, 1}, o, x, {0, -1, -1}});
  const struct {
    const char* name;
    Soup soup;
  } cases[] = {
      {"a sheet", with(nothing, sheet(3, 1.0, {0, 0, 0}))},
      {"a large and a small sheet", with(nothing, both)},
      {"three sheets at one edge", three_sheets},
      {"a sail", with(cube(), {o, x, {0.5, -1.5, -1.5}})},
      {"a large sheet beside a cube", with(cube(), sheet(2, 1.0, {2, 0, 0}))},
      {"panels beside a cube", with(cube(), panels)},
      {"an open box with a fin", with(open_box, {o, x, {0.5, -0.5, -0.5}})},
      {"an open box with a stray triangle", with(open_box, {{2, 0, 0}, {2.2, 0, 0}, {2, 0.3, 0.1}})},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name);
    const Mesh mesh = c.soup.build();
    const RepairedMesh repaired = repair_mesh(mesh, {.max_hole = 0});
    EXPECT_EQ(repaired.mesh.hash(), mesh.hash());
    EXPECT_EQ(repaired.log.total(), 0u);
  }
  // Two cubes with a common wall of two layers, two that touch in an edge, a cube with a flap of two layers: solids.
  Soup flap = with(cube(), {o, x, {0.5, -0.5, -0.5}, x, o, {0.5, -0.5, -0.5}});
  Soup touching = cube();
  const auto n = static_cast<std::uint32_t>(touching.vertices.size());
  for (const V& p : Points(touching.vertices)) touching.vertices.push_back(p + V(1, 1, 0));
  for (const Triangle& t : std::vector<Triangle>(touching.triangles))
    touching.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  for (const Soup& soup : {flap, touching}) {
    const Mesh mesh = soup.build();
    ASSERT_TRUE(mesh.solid());
    EXPECT_EQ(repair_mesh(mesh).mesh.hash(), mesh.hash());
  }
}

TEST(Superfluous, KeepsToTheSizeAskedFor) {
  const Mesh mesh = with(cube(), {{0, 0, 0}, {1, 0, 0}, {0.5, -0.5, -0.5}}).build();  // 0.354 of 6
  EXPECT_EQ(repair_mesh(mesh, {.max_fin = 0.058}).log.total(), 0u);
  EXPECT_EQ(count(repair_mesh(mesh, {.max_fin = 0.06}), RepairKind::fins), 1u);
  EXPECT_THROW(repair_mesh(mesh, {.max_fin = -0.1}), BadArgument);
  EXPECT_THROW(repair_mesh(mesh, {.max_fin = std::nan("")}), BadArgument);
}

/// A shape with fins, walls that cut off vertices, chains without area, duplicates and stray triangles, all at random.
class Damage {
 public:
  Damage(const Mesh& mesh, std::uint64_t seed)
      : mesh_(mesh), generator_(seed), soup_(mesh), used_(mesh.vertices().size(), 0) {}

  Mesh damaged(std::size_t of_each) {
    for (std::size_t i = 0; i < of_each; ++i) {
      add_fin();
      add_wall();
      add_chain();
      add_stray();
      damage::duplicate(soup_, generator_, 1);
    }
    return soup_.build();
  }

 private:
  /// A triangle whose corners have no other damage yet.
  Triangle fresh() {
    for (;;) {
      const Triangle& t = mesh_.triangles()[damage::pick(generator_, mesh_.triangles().size())];
      if (used_[t[0]] + used_[t[1]] + used_[t[2]] > 0) continue;
      for (const std::uint32_t v : t) used_[v] = 1;
      return t;
    }
  }
  double size(const Triangle& t) const { return (mesh_.vertices()[t[0]] - mesh_.vertices()[t[1]]).norm(); }

  /// One to three triangles, as a strip that leads away from an edge.
  void add_fin() {
    const Triangle t = fresh();
    std::uint32_t a = t[0], b = t[1];
    for (std::size_t i = 0; i < 1 + damage::pick(generator_, 3); ++i) {
      const std::uint32_t c = damage::add(soup_, soup_.vertices[b] + shapes::uniform_vector(generator_, size(t)));
      soup_.triangles.push_back({a, b, c});
      a = b;
      b = c;
    }
  }

  /// Below a vertex, between its neighbours.
  void add_wall() {
    for (;;) {
      const std::uint32_t v = fresh()[0];
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      std::vector<Triangle> around;
      double shortest = 1e300;
      for (const Triangle& t : mesh_.triangles()) {
        if (std::find(t.begin(), t.end(), v) == t.end()) continue;
        around.push_back(t);
        const auto& p = mesh_.vertices();
        normal += (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized();
        for (std::size_t k = 0; k < 3; ++k) shortest = std::min(shortest, (p[t[k]] - p[t[(k + 1) % 3]]).norm());
      }
      normal.normalize();
      bool visible = true;  // from inside, all triangles around the vertex
      for (const Triangle& t : around) {
        const auto& p = mesh_.vertices();
        visible = visible && normal.dot((p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized()) > 0.3;
      }
      if (!visible) continue;
      const std::uint32_t below = damage::add(soup_, mesh_.vertices()[v] - 0.2 * shortest * normal);
      for (Triangle t : around) {
        std::replace(t.begin(), t.end(), v, below);
        for (const std::uint32_t w : t) {
          if (w < used_.size()) used_[w] = 1;
        }
        soup_.triangles.push_back(t);
      }
      return;
    }
  }

  /// Triangles without area along an edge.
  void add_chain() {
    const Triangle t = fresh();
    const Eigen::Vector3d a = mesh_.vertices()[t[0]], b = mesh_.vertices()[t[1]];
    std::uint32_t last = damage::add(soup_, a + 0.25 * (b - a));
    for (const double s : {0.5, 0.75}) {
      const std::uint32_t next = damage::add(soup_, a + s * (b - a));
      soup_.triangles.push_back({t[0], last, next});
      last = next;
    }
    soup_.triangles.push_back({t[0], last, t[1]});
  }

  void add_stray() {
    const Eigen::Vector3d at = mesh_.center() + shapes::uniform_vector(generator_, mesh_.diagonal());
    Triangle t{};
    for (std::uint32_t& v : t) v = damage::add(soup_, at + shapes::uniform_vector(generator_, 0.01 * mesh_.diagonal()));
    soup_.triangles.push_back(t);
  }

  const Mesh& mesh_;
  shapes::Generator generator_;
  Soup soup_;
  std::vector<int> used_;
};

TEST(Superfluous, GoesFromShapesDamagedAtRandom) {
  for (const char* name : {"torus-2k", "gyroid-ball-5k", "bumpy-sphere-1k", "torus-knot-3k"}) {
    const Mesh mesh = load_model(name);
    ASSERT_TRUE(mesh.solid());
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      SCOPED_TRACE(name + std::string(", seed ") + std::to_string(seed));
      const Mesh damaged = Damage(mesh, seed).damaged(1 + seed % 6);
      ASSERT_FALSE(damaged.solid());
      const RepairedMesh repaired = repair_mesh(damaged);
      EXPECT_TRUE(repaired.mesh.solid()) << repaired.mesh.why_not_solid();
      EXPECT_EQ(repaired.mesh.hash(), mesh.hash());
      EXPECT_GE(count(repaired, RepairKind::inner_walls), 3 * (1 + seed % 6));
      EXPECT_EQ(count(repaired, RepairKind::filled_holes), 0u);
      EXPECT_TRUE(repaired.converged);
      EXPECT_EQ(repair_mesh(repaired.mesh).log.total(), 0u);
    }
  }
}

}  // namespace
}  // namespace sixdof
