#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sixdof/geometry/pose.h>

namespace sixdof::bench {

/// Truths at some poses as the cache on disk (base/cache.h) keeps them: for each pose some numbers, and a word of
/// flags.
struct StoredTruths {
  std::vector<double> numbers;
  std::vector<std::uint32_t> flags;
};

/// By all bits of the poses.
std::string hash_of(std::span<const Pose> poses);

/// @param count of the poses; @param numbers for each of them
/// @return none if there is no entry, or one of another form
std::optional<StoredTruths> load_truths(const char* kind, const std::string& key, std::size_t count,
                                        std::size_t numbers);
void store_truths(const char* kind, const std::string& key, StoredTruths truths);

}  // namespace sixdof::bench
