#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace sixdof::test {

/// Two small sets with a manifest, on models made from recipes, for the tests of sets and of the harness. They are made
/// once, when the tests are built, because every test runs in a process of its own.
struct SmallSuite {
  static constexpr std::size_t k_configurations = 288;  ///< In each bucket: 6 directions x 48 rotations.

  /// Pairs torus-1k (two copies, torus-1k.h5) and torus-1k-cone-1k (two models), both with these buckets.
  static const std::vector<std::string>& buckets();

  /// Writes sets and manifest into a folder that exists.
  static void make(const std::filesystem::path& directory);
};

/// A copy of the suite that a test may change; removed by the destructor.
class SuiteCopy {
 public:
  explicit SuiteCopy(const std::filesystem::path& original);
  ~SuiteCopy();
  SuiteCopy(const SuiteCopy&) = delete;
  SuiteCopy& operator=(const SuiteCopy&) = delete;

  const std::filesystem::path& directory() const { return directory_; }
  std::filesystem::path manifest() const { return directory_ / "manifest.json"; }

 private:
  std::filesystem::path directory_;
};

}  // namespace sixdof::test
