#include <sixdof/algorithm/mujoco/mujoco.h>

#include <sixdof/base/error.h>

#include "../hull_checks.h"

namespace sixdof {
namespace {

TEST(MujocoHull, AnswersForTheHulls) {
  test::expect_answers_for_hulls(*make_mujoco_hull_algorithm());
  test::expect_yes_where_meshes_are_apart(*make_mujoco_hull_algorithm());
}

TEST(MujocoHull, IsLabelledAndFailsOnAPoseThatIsNotFinite) { test::expect_hull_manners(*make_mujoco_hull_algorithm()); }

TEST(MujocoHull, RefusesAFlatMeshWithoutPrinting) {
  const Mesh flat = Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}, "flat");
  const Mesh solid = load_model("cone-1k");
  ::testing::internal::CaptureStderr();
  EXPECT_THROW(test::prepare(*make_mujoco_hull_algorithm(), flat, solid), BadMesh);
  EXPECT_THROW(test::prepare(*make_mujoco_hull_algorithm(), solid, flat), BadMesh);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace sixdof
