#include <sixdof/oracle/near_query.h>

#include <random>

#include <gtest/gtest.h>

#include <sixdof/models/recipe.h>
#include <sixdof/oracle/distance.h>

namespace sixdof {
namespace {

/// Poses from overlap to a few sizes apart.
std::vector<Pose> poses(std::size_t count) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Pose> found;
  while (found.size() < count) {
    const Eigen::Quaterniond q(unit(random), unit(random), unit(random), unit(random));
    if (q.norm() < 0.1) continue;
    const Eigen::Vector3d t(2.2 * unit(random), 2.2 * unit(random), 2.2 * unit(random));
    found.push_back({q.normalized().toRotationMatrix(), t});
  }
  return found;
}

/// Boxes have coplanar patches, so that distances may tie.
TEST(NearQuery, HasTheBitsOfTheDistanceOracleUpToTheLimit) {
  const std::vector<Mesh> meshes{make_box({}, 300), make_torus({}, 500), make_sphere({.radius = 0.6}, 320)};
  NearQuery query;
  std::size_t within = 0, beyond = 0;
  for (const Mesh& a : meshes) {
    for (const Mesh& b : meshes) {
      const DistanceOracle oracle(a, b);
      DistanceQuery reference(oracle);
      const PreparedMesh prepared_a(a), prepared_b(b);
      NearHint hint;  // of the pose before
      for (const Pose& X_AB : poses(60)) {
        const double d = reference.distance(X_AB, false).distance;
        for (const double limit : {0.0, 0.5 * d, std::nextafter(d, 0.0), d, 1.1 * d + 0.01, NearQuery::k_no_limit}) {
          for (const bool warm : {false, true}) {
            NearHint start = warm ? hint : NearHint{};
            const auto found = query.distance(prepared_a, prepared_b, X_AB, limit, start);
            ASSERT_EQ(found.has_value(), d <= limit) << d << " " << limit;
            if (found) {
              ASSERT_EQ(*found, d);
              ASSERT_TRUE(start.known());
            }
            ++(found ? within : beyond);
          }
        }
        NearHint start = hint;
        ASSERT_EQ(query.surfaces_meet(prepared_a, prepared_b, X_AB, start), d == 0.0);
        ASSERT_EQ(query.surfaces_meet(prepared_a, prepared_b, X_AB, hint), d == 0.0);
      }
    }
  }
  EXPECT_GT(within, 1000u);
  EXPECT_GT(beyond, 500u);
}

TEST(NearQuery, LooksAtLessWithALimit) {
  const Mesh a = make_torus_knot({}, 4000), b = make_torus({}, 3000);
  const PreparedMesh prepared_a(a), prepared_b(b);
  const Pose X_AB{Eigen::Matrix3d::Identity(), {3.6, 0.2, 0.4}};
  NearQuery with_limit, without;
  NearHint none;
  const auto d = without.distance(prepared_a, prepared_b, X_AB, NearQuery::k_no_limit, none);
  ASSERT_TRUE(d);
  ASSERT_GT(*d, 0.2);
  none = {};
  EXPECT_FALSE(with_limit.distance(prepared_a, prepared_b, X_AB, 0.1 * *d, none));
  EXPECT_FALSE(none.known());
  EXPECT_LT(4 * with_limit.counts().nodes, without.counts().nodes);
  EXPECT_LE(with_limit.counts().triangles, without.counts().triangles);
}

}  // namespace
}  // namespace sixdof
