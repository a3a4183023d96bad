#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace sixdof {

/// JSON as text in UTF-8, for files and standard output. A NaN or an infinity becomes null; bytes that are not UTF-8,
/// e.g. of a file's name, become U+FFFD.
/// @param indent spaces per level; -1: all on one line
std::string json_text(const nlohmann::ordered_json& json, int indent = 2);

}  // namespace sixdof
