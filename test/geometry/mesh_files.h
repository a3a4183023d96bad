#pragma once

// Meshes and files that the tests of loading and saving share.

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/geometry/load.h>
#include <sixdof/geometry/mesh.h>

namespace sixdof::testing_support {

/// A closed torus without symmetry: radii vary, every vertex is jittered. n * m vertices, 2 n m triangles.
inline Mesh bumpy_torus(std::size_t n, std::size_t m, double scale, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> jitter(-0.01, 0.01);
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < n; ++i) {
    const double u = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
    for (std::size_t j = 0; j < m; ++j) {
      const double v = 2.0 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(m);
      const double tube = 0.31 + 0.05 * std::sin(3.0 * u) + 0.1 * jitter(generator);
      const double radius = 1.07 + tube * std::cos(v);
      vertices.emplace_back(
          scale * Eigen::Vector3d(radius * std::cos(u) + 0.37, radius * std::sin(u) - 0.21, tube * std::sin(v) + 0.83));
      const auto index = [&](std::size_t a, std::size_t b) { return static_cast<std::uint32_t>(a % n * m + b % m); };
      triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  return Mesh::build(std::move(vertices), std::move(triangles), "torus");
}

/// A folder of this process's own, removed at the end of the test.
class TestFolder : public ::testing::Test {
 protected:
  TestFolder() : folder_(parent() / ("sixdof_geometry_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~TestFolder() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  /// A file system in memory if there is one: the tests of damaged files write thousands.
  static std::filesystem::path parent() { return ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : ::testing::TempDir(); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }

  static std::string read(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::filesystem::path folder_;
};

/// The message that loading a file ends with, or "accepted". Anything but BadFile fails the test.
inline std::string message_of(const std::filesystem::path& file) {
  try {
    load_mesh(file);
  } catch (const BadFile& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace sixdof::testing_support
