#pragma once

#include <filesystem>

namespace sixdof::fuzz {

/// Write a valid set, and a valid shard, of a few configurations. @return the file
std::filesystem::path write_small_set(const std::filesystem::path& folder);
std::filesystem::path write_small_shard(const std::filesystem::path& folder);

}  // namespace sixdof::fuzz
