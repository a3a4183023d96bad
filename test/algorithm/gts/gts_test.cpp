#include <sixdof/algorithm/gts/gts.h>

#include <thread>

#include <sixdof/base/error.h>
#include <sixdof/conformance/conformance.h>

#include "../volume_checks.h"

namespace sixdof {
namespace {

/// GTS's new vertices are rounded to doubles: a few roundings, of volumes of a thousandth of the cube of the diagonal.
constexpr double k_rounding = 1e-9;

SIXDOF_CONFORMANCE(make_gts_algorithm);

TEST(Gts, AnswersAsExactWhereItIsClear) { test::expect_clear_yes_no(*make_gts_algorithm()); }

TEST(Gts, GivesTheVolumeAndItsGradient) {
  test::expect_response_of_exact(*make_gts_algorithm(), k_rounding);
  test::expect_volume_of_inner_body(*make_gts_algorithm());
}

/// Not to the bit: GTS's hash tables are in the order of addresses, and so are its sums.
TEST(Gts, RepeatsItselfToRounding) {
  const test::ClearPoses clear(20);
  const auto query = test::prepare(*make_gts_algorithm(), clear.a, clear.b);
  std::vector<Response> first;
  for (const auto& [X_AB, overlap] : clear.poses) first.push_back(query->respond(X_AB).value);
  for (std::size_t i = clear.poses.size(); i-- > 0;) {
    const Response again = query->respond(clear.poses[i].first).value;
    EXPECT_LE((again.force - first[i].force).norm(), k_rounding * first[i].force.norm());
    EXPECT_LE((again.torque - first[i].torque).norm(), k_rounding * first[i].force.norm());
    EXPECT_NEAR(again.volume, first[i].volume, k_rounding * first[i].volume);
  }
}

TEST(Gts, FailsOnAPoseThatIsNotFinite) { test::expect_no_answer_where_not_finite(*make_gts_algorithm()); }

TEST(Gts, RefusesAnOpenMesh) {
  const Mesh ball = sphere_solid(1.0, 8, RoundParts::inscribed, "ball");
  std::vector<Triangle> triangles = ball.triangles();
  triangles.pop_back();
  const Mesh open = Mesh::build(ball.vertices(), triangles, "open");
  EXPECT_THROW(test::prepare(*make_gts_algorithm(), open, ball), BadMesh);
  EXPECT_THROW(test::prepare(*make_gts_algorithm(), ball, open), BadMesh);
}

TEST(Gts, LetsThreadsTakeTurns) {
  const test::ClearPoses clear(10);
  const auto algorithm = make_gts_algorithm();
  std::vector<double> expected;
  const auto query = test::prepare(*algorithm, clear.a, clear.b);
  for (const auto& [X_AB, overlap] : clear.poses) expected.push_back(query->respond(X_AB).value.volume);
  std::vector<std::thread> threads;
  std::vector<std::vector<double>> got(3);
  for (auto& mine : got) {
    threads.emplace_back([&] {
      const auto own = test::prepare(*algorithm, clear.a, clear.b);
      for (const auto& [X_AB, overlap] : clear.poses) mine.push_back(own->respond(X_AB).value.volume);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& mine : got) EXPECT_THAT(mine, ::testing::Pointwise(::testing::DoubleNear(k_rounding), expected));
}

}  // namespace
}  // namespace sixdof
