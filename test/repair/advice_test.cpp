#include <sixdof/repair/advice.h>

#include <gtest/gtest.h>

#include "damage.h"

namespace sixdof {
namespace {

using damage::Soup;

TEST(RepairAdvice, FindsTheToleranceOfWideGaps) {
  const Mesh ball = shapes::bumpy_sphere(3, 0.2);
  shapes::Generator generator(5);
  Soup soup(ball);
  const double noise = 1e-5 * ball.diagonal();  // in each coordinate, so up to 3.5e-5 between two
  damage::split_vertices(soup, generator, 200, noise);
  const Mesh damaged = soup.build();
  const RepairOptions usual{.max_hole = 0};  // small holes would be filled instead
  ASSERT_FALSE(repair_mesh(damaged, usual).mesh.solid());
  const std::vector<RepairAttempt> attempts = try_other_repairs(damaged, usual);
  ASSERT_TRUE(attempts.back().solid);
  EXPECT_GE(attempts.back().options.weld, 1e-5);
  EXPECT_LE(attempts.back().options.weld, 1e-4);
  EXPECT_EQ(attempts.back().options.max_hole, usual.max_hole);
  EXPECT_GT(attempts.front().border_edges, 0u);
  EXPECT_TRUE(repair_mesh(damaged, attempts.back().options).mesh.solid());
}

TEST(RepairAdvice, FindsTheSizeOfALargeHole) {
  const Mesh ball = shapes::bumpy_sphere(4, 0.0);
  Soup soup(ball);
  // The cap above a plane: a hole of as many edges as the circle there has.
  std::erase_if(soup.triangles, [&](const Triangle& t) {
    return ball.vertices()[t[0]].z() > 0.1 && ball.vertices()[t[1]].z() > 0.1 && ball.vertices()[t[2]].z() > 0.1;
  });
  const Mesh open = soup.build();
  ASSERT_GT(open.topology().border_edges, RepairOptions::k_default_max_hole);
  const std::vector<RepairAttempt> attempts = try_other_repairs(open, {});
  ASSERT_TRUE(attempts.back().solid);
  EXPECT_GT(attempts.back().options.max_hole, RepairOptions::k_default_max_hole);
}

TEST(RepairAdvice, SaysThatNothingHelps) {
  const Mesh sheet = Mesh::build({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1}}, {{0, 1, 2}, {0, 2, 3}}, "sheet");
  const std::vector<RepairAttempt> attempts = try_other_repairs(sheet, {.max_hole = 0});
  EXPECT_FALSE(attempts.back().solid);
  EXPECT_LE(attempts.size(), 10u);
}

}  // namespace
}  // namespace sixdof
