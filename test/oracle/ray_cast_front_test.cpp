#include <sixdof/oracle/ray_cast_search.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include <sixdof/generation/distance_generator.h>
#include <sixdof/models/model_catalogue.h>

#include "../configuration/shapes.h"
#include "triangles_of.h"

namespace sixdof::ray_cast {
namespace {

using test::least_distance;
using test::random_direction;
using test::random_rotation;
using test::triangles_of;

/// A bound may be above the distance by the rounding of keeping and reading it, in units of Cast::size(), less what it
/// is lowered by where it is made.
constexpr double k_rounding = 1e-7;
/// Of translations along one ray, found with and without a front: the error of exact distances.
constexpr double k_same_translation = 1e-12;

struct Meshes {
  Meshes(const Mesh& mesh_a, const Mesh& mesh_b, const Eigen::Vector4d& q)
      : a(std::make_shared<Tree>(mesh_a)),
        b(std::make_shared<Tree>(mesh_b)),
        R(ConfigurationRay(mesh_a, mesh_b, q).R) {}
  CastMesh a, b;
  Eigen::Matrix3d R;
};

Cast cast_along(const Meshes& meshes, const Eigen::Vector3d& u) {
  Cast cast(meshes.a, meshes.b);
  cast.set_rotation(meshes.R);
  cast.direction = u;
  return cast;
}

/// Searches without a guess. Returns the translation, or less than 0 where nothing is hit.
double find(Cast& cast, double target) {
  cast.target = target;
  cast.best = {.translation = -k_cast_tie * cast.size(), .pair = {}, .axis = cast.direction};
  find_first_hit(cast);
  return cast.best.pair ? cast.best.translation : -1.0;
}

/// Checks every bound of the front whose volumes do not have too many pairs of triangles; returns how many.
int check_bounds(const Cast& cast) {
  constexpr std::uint64_t k_most_pairs = 256;
  int checked = 0;
  for (std::size_t n = 0; n < cast.front.expansions.size(); ++n) {
    const CastFront::Expansion& expansion = cast.front.expansions[n];
    for (std::uint32_t lane = 0; lane < Tree::k_width; ++lane) {
      const float offset = cast.front.bounds[n].offset[lane];
      const float slope = cast.front.bounds[n].slope[lane];
      if (offset == CastFront::k_no_bound || offset == CastFront::k_not_in_front) continue;
      EXPECT_GE(slope, 0.0f);
      EXPECT_LE(slope, 1.0f + 1e-6f);
      const Tree& tree = (expansion.expands_a ? cast.a : cast.b).tree();
      const std::uint32_t own = detail::CloseVolume::child_of(tree.nodes()[expansion.node], lane).volume;
      const std::uint32_t a = expansion.expands_a ? own : expansion.other;
      const std::uint32_t b = expansion.expands_a ? expansion.other : own;
      if (std::uint64_t{triangles_of(cast.a.tree(), a).second} * triangles_of(cast.b.tree(), b).second > k_most_pairs)
        continue;
      // At translations above that at which the bound was made, it says no more than that the target is exceeded.
      for (const double fraction : {0.0, 0.31, 0.77, 0.95, 1.0, 1.04}) {
        const double t = fraction * cast.best.translation;
        const double bound = static_cast<double>(offset) + static_cast<double>(slope) * t;
        EXPECT_LE(std::min(bound, cast.target), least_distance(cast, a, b, t) + k_rounding * cast.size())
            << "expansion " << n << ", lane " << lane << ", fraction " << fraction;
      }
      ++checked;
    }
  }
  return checked;
}

TEST(CastFront, BoundsAreNeverAboveTheDistance) {
  std::mt19937_64 random(41);
  const std::vector<std::pair<Mesh, Mesh>> pairs{
      {load_model("bumpy-sphere-600"), load_model("gyroid-ball-1200")},
      {load_model("gyroid-ball-1200"), load_model("bumpy-sphere-600")},
      {load_model("torus-knot-600"), load_model("torus-knot-600")},
      {test::boxes_mesh({{{0.3, 0.1, -0.2}, {1.0, 0.7, 1e-4}}}, "plate"), load_model("box-300")},
      {load_model("box-300"), load_model("box-300")},
  };
  int checked = 0;
  for (const auto& [a, b] : pairs) {
    for (int i = 0; i < 5; ++i) {
      const Meshes meshes(a, b, random_rotation(random));
      Cast cast = cast_along(meshes, random_direction(random));
      for (const double percent : {22.0, 21.0, 4.0, 1e-9}) {
        if (find(cast, 0.01 * percent * a.diagonal()) < 0.0) break;
        checked += check_bounds(cast);
      }
    }
  }
  EXPECT_GT(checked, 10'000);
}

TEST(CastFront, FindsTheSameHitsAndSavesMostOfTheWork) {
  std::mt19937_64 random(42);
  const Mesh a = load_model("torus-knot-10k");
  const Mesh b = load_model("gyroid-ball-10k");
  std::uint64_t with_front = 0;
  std::uint64_t without = 0;
  for (const auto& [first, second] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (int i = 0; i < 4; ++i) {
      const Meshes meshes(*first, *second, random_rotation(random));
      const Eigen::Vector3d u = random_direction(random);
      Cast cast = cast_along(meshes, u);
      for (int percent = 30; percent >= 0; --percent) {
        const double target = distance_bucket(*first, percent).target;
        Cast fresh = cast_along(meshes, u);
        EXPECT_NEAR(find(cast, target), find(fresh, target), k_same_translation * cast.size()) << percent;
        without += fresh.counts.nodes + fresh.counts.leaf_pairs;
      }
      with_front += cast.counts.nodes + cast.counts.leaf_pairs;
    }
  }
  // Counts are the same on every machine. The fraction is a third to a fifth.
  EXPECT_LT(with_front, without / 2);
}

TEST(CastFront, TakesTargetsInAnyOrder) {
  std::mt19937_64 random(43);
  const Mesh a = load_model("torus-knot-2000");
  const Mesh b = load_model("bumpy-sphere-600");
  for (int i = 0; i < 10; ++i) {
    const Meshes meshes(a, b, random_rotation(random));
    const Eigen::Vector3d u = random_direction(random);
    Cast cast = cast_along(meshes, u);
    for (const double percent : {3.0, 12.0, 0.5, 0.5, 30.0, 1.0}) {
      const double target = 0.01 * percent * a.diagonal();
      Cast fresh = cast_along(meshes, u);
      EXPECT_NEAR(find(cast, target), find(fresh, target), k_same_translation * cast.size()) << percent;
    }
  }
}

}  // namespace
}  // namespace sixdof::ray_cast
