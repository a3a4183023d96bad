#pragma once

#include <filesystem>
#include <string_view>

#include <nlohmann/json.hpp>

namespace sixdof::bench {

/// A result in JSON has a member "checksum" in "context" and in each of "benchmarks", a string of 32 digits, so that
/// --resume continues only what a run wrote. It depends on the values, not on white space. The checksum of a
/// row depends on the context as well.

/// Adds the checksums.
void add_checksums(nlohmann::ordered_json& document);

/// Checks and removes the checksums.
/// @param text of the file, to name the line
/// @throws BadFile naming file, line and row of the first checksum that is missing or wrong
void take_checksums(nlohmann::ordered_json& document, const std::filesystem::path& file, std::string_view text);

}  // namespace sixdof::bench
