#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::results {

/// The document of a result file, with strings and keys that are visible (base/visible_text.h): names and words in it
/// are those of algorithms, meshes and machines. @param path named in messages
/// @throws BadFile if it is empty or no JSON
nlohmann::ordered_json parse_document(const std::string& text, const std::string& path);

/// The words of nlohmann::json's exceptions behind "[json.exception.parse_error.101] ".
std::string words_of(const nlohmann::json::exception& e);

/// The text of a member, empty where there is none.
std::string text_at(const nlohmann::ordered_json& object, const char* key);

/// Adds the elements of an array to those of other files, none where there is no such member.
/// @throws Error, and what conversions throw
template <class Element>
void take_elements(const nlohmann::ordered_json& parent, const char* key, std::size_t file,
                   std::vector<Element>& list) {
  const nlohmann::json array = parent.value(key, nlohmann::ordered_json::array());
  if (!array.is_array()) throw Error(fmt::format("\"{}\" is no array", key));
  for (const nlohmann::json& each : array) {
    list.push_back(each.get<Element>());
    list.back().file = file;
  }
}

/// How many nanoseconds a time_unit of Google Benchmark has. @throws Error
double nanoseconds(const std::string& time_unit);

}  // namespace sixdof::results
