#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/models/recipe.h>
#include <sixdof/scene/families.h>
#include <sixdof/scene/scene.h>

namespace sixdof::scene {

/// The message of the error E that f throws; fails if there is none.
template <class E, class F>
std::string message_of(const F& f) {
  try {
    f();
  } catch (const E& e) {
    return e.what();
  }
  ADD_FAILURE() << "nothing is thrown";
  return {};
}

/// Spheres of radius 1 in a row, `gap` apart, inserted from right to left; the first of them moves by `step` along the
/// row in each further frame.
inline Scene row_of_spheres(std::uint32_t count, double gap, double step, std::size_t frames, double margin) {
  Scene scene;
  scene.margin = margin;
  scene.meshes.push_back(std::make_shared<const Mesh>(make_sphere({}, 320)));
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (std::uint32_t i = count; i-- > 0;) {
    scene.bodies.push_back({10 + i, 0, false, RecordedPose::of(R, {(2.0 + gap) * i, 0.1, -0.2})});
  }
  scene.frames.resize(1);
  for (std::size_t f = 1; f < frames; ++f) {
    const double x = step * static_cast<double>(f);
    scene.frames.push_back({{count - 1, RecordedPose::of(R, {x, 0.1, -0.2})}});
  }
  return scene;
}

}  // namespace sixdof::scene
