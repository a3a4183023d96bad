#pragma once

#include <filesystem>
#include <string_view>

#include <nlohmann/json.hpp>

namespace sixdof::bench {

/// A result in JSON has a member "checksum" in "context" and in each of "benchmarks", a string of 32 digits, so that
/// --resume continues only what a run wrote. It depends on the values, not on blanks and breaks; that of a row on the
/// context, too.

/// Adds them.
void add_checksums(nlohmann::ordered_json& document);

/// Checks and removes them.
/// @param text of the file, to name the line
/// @throws BadFile naming file, line and row of the first that is missing or does not fit
void take_checksums(nlohmann::ordered_json& document, const std::filesystem::path& file, std::string_view text);

}  // namespace sixdof::bench
