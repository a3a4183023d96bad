#pragma once

#include <map>
#include <sstream>
#include <string>
#include <string_view>

namespace sixdof {

/// The parts of a row's name by their keys: "collide/algorithm:exact/pair:ship" is {"query", "collide"}, {"algorithm",
/// "exact"}, {"pair", "ship"}. Parts without a colon behind the first have no key and are left out.
inline std::map<std::string, std::string> row_name_parts(std::string_view name) {
  std::map<std::string, std::string> parts;
  std::istringstream words{std::string(name)};
  std::getline(words, parts["query"], '/');
  for (std::string word; std::getline(words, word, '/');) {
    const auto colon = word.find(':');
    if (colon != std::string::npos) parts[word.substr(0, colon)] = word.substr(colon + 1);
  }
  return parts;
}

}  // namespace sixdof
