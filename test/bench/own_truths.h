#pragma once

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <sixdof/models/recipe.h>

#include "../oracle/bodies.h"

namespace sixdof::bench {

/// Two bodies that overlap at some poses, and a cache of their own.
struct OwnTruths : ::testing::Test {
  const Mesh a = make_torus_knot({}, 600), b = make_bumpy_sphere({}, 400);
  const std::filesystem::path cache;

  explicit OwnTruths(const std::string& name) : cache(std::filesystem::path(::testing::TempDir()) / name) {
    std::filesystem::remove_all(cache);
    ::setenv("SIXDOF_CACHE", cache.c_str(), 1);
  }
  ~OwnTruths() override {
    ::unsetenv("SIXDOF_CACHE");
    std::filesystem::remove_all(cache);
  }
  static std::vector<Pose> poses(std::size_t count) {
    std::mt19937_64 random(3);
    std::vector<Pose> list;
    while (list.size() < count) {
      list.push_back(bodies::random_pose(random, 0.1));
      list.back().t += Eigen::Vector3d(1.1, 0.7, 0.1);
    }
    return list;
  }
};

}  // namespace sixdof::bench
