#include <sixdof/algorithm/embree/embree.h>

#include <ctime>

#include <sixdof/base/error.h>
#include <sixdof/conformance/conformance.h>

#include "../contact_checks.h"

namespace sixdof {
namespace {

SIXDOF_CONFORMANCE(make_embree_algorithm);

class Embree : public ::testing::TestWithParam<const char*> {
 protected:
  const std::unique_ptr<Algorithm> algorithm = make_embree_algorithm();
  const std::vector<std::string> parameters = {std::string("profile=") + GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Profiles, Embree, ::testing::Values("default", "tuned"),
                         [](const auto& profile) { return std::string(profile.param); });

TEST_P(Embree, AnswersAsExactWhereItIsClear) { test::expect_clear_yes_no(*algorithm, parameters); }

TEST_P(Embree, LosesNoPairToSinglePrecision) {
  test::expect_close_yes_no(*algorithm, parameters);
  test::expect_touching_boxes_collide(*algorithm, parameters);
}

TEST_P(Embree, KeepsToTheCallersThread) {
  const Mesh a = load_model("torus-10k");
  const auto seconds = [](clockid_t clock) {
    timespec now;
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  const double process = seconds(CLOCK_PROCESS_CPUTIME_ID), thread = seconds(CLOCK_THREAD_CPUTIME_ID);
  const auto query = test::prepare(*algorithm, a, a, parameters);
  std::mt19937_64 random(3);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(query->collide(test::generic_pose(random, 0.2)).ok());
  // Workers that helped would add to the process only; a tenth is for those that wake up and find nothing.
  EXPECT_LT(seconds(CLOCK_PROCESS_CPUTIME_ID) - process, 1.1 * (seconds(CLOCK_THREAD_CPUTIME_ID) - thread));
}

TEST_P(Embree, FailsOnAPoseThatItCannotAnswer) {
  const test::BallOnFace t;
  const auto query = test::prepare(*algorithm, t.block, t.ball, parameters);
  Pose bad = t.X_AB;
  bad.R(2, 1) = std::nan("");
  EXPECT_EQ(query->collide(bad).status, Status::failed);
  EXPECT_THAT(query->diagnosis(), ::testing::HasSubstr("not finite"));
  bad = t.X_AB;
  bad.t.z() = 1e19;
  EXPECT_EQ(query->collide(bad).status, Status::failed);
  EXPECT_THAT(query->diagnosis(), ::testing::HasSubstr("beyond Embree's largest"));
  EXPECT_TRUE(query->collide(t.X_AB).value);
  EXPECT_EQ(query->distance(t.X_AB).status, Status::unsupported);
  EXPECT_EQ(query->respond(t.X_AB).status, Status::unsupported);
}

TEST_P(Embree, RefusesAMeshThatEmbreeWouldDrop) {
  const Mesh small = box_solid({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}, "small");
  const Mesh huge = box_solid({-1e19, -1.0, -1.0}, {1.0, 1.0, 1.0}, "huge");
  EXPECT_THROW(test::prepare(*algorithm, huge, small, parameters), BadMesh);
  EXPECT_THROW(test::prepare(*algorithm, small, huge, parameters), BadMesh);
}

TEST_P(Embree, KnowsSurfacesOnly) {
  const test::BallOnFace t;
  Pose inside = t.X_AB;
  inside.t.y() = -14.0;
  EXPECT_FALSE(test::prepare(*algorithm, t.block, t.ball, parameters)->collide(inside).value);
}

}  // namespace
}  // namespace sixdof
