#include <sixdof/scene/truth.h>

#include <algorithm>
#include <array>

#include <sixdof/scene/all_pairs.h>
#include "small_scenes.h"

namespace sixdof::scene {
namespace {

/// Spheres that overlap in a row, turned without a trigonometric function: the scene has the same bits everywhere.
Scene overlapping_spheres() {
  Scene scene = row_of_spheres(4, -0.125, 0.25, 3, 0.5);
  const auto turn = [](RecordedPose& pose, std::uint32_t body) {
    const double sign = body % 2 == 0 ? 1.0 : -1.0;
    std::ranges::copy(std::array{0.8, 0.36, sign * 0.48, 0.0}, pose.numbers.begin());
  };
  for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) turn(scene.bodies[i].pose, i);
  for (Frame& frame : scene.frames) {
    for (Motion& motion : frame) turn(motion.pose, motion.body);
  }
  return scene;
}

// The cache on disk must not mix answers of two programs: algorithms of this project are asked for the truth's bits.
TEST(Truth, ItsBitsBelongToItsVersion) {
  const Scene scene = overlapping_spheres();
  const Truth truth = replay(scene, *make_all_pairs(), Question::wrenches);
  EXPECT_EQ(truth.pairs(), 9u);
  EXPECT_EQ(std::pair(k_truth_version, truth.hash), std::pair(6, std::string("67732e2cfb16e3a548127e245f65bd1e")))
      << "answers have other bits: raise k_truth_version, and name it and the new hash here";
}

}  // namespace
}  // namespace sixdof::scene
