#include "bench/harness/suite.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::bench {
namespace {

/// The parts of a row's name by their keys: "collide/algorithm:exact/pair:ship" is {"query", "collide"}, {"algorithm",
/// "exact"}, {"pair", "ship"}. Parts without a colon behind the first have no key and are left out.
std::map<std::string, std::string> row_name_parts(std::string_view name) {
  std::map<std::string, std::string> parts;
  std::istringstream words{std::string(name)};
  std::getline(words, parts["query"], '/');
  for (std::string word; std::getline(words, word, '/');) {
    const auto colon = word.find(':');
    if (colon != std::string::npos) parts[word.substr(0, colon)] = word.substr(colon + 1);
  }
  return parts;
}

bool is_one_of(const std::vector<std::string>& list, const std::string& word) {
  return std::ranges::find(list, word) != list.end();
}

}  // namespace

Suite read_suite(const std::filesystem::path& file, const std::vector<std::string>& external_algorithms,
                 const std::vector<std::string>& named_only) {
  std::ifstream in(file);
  if (!in) throw BadFile(file.string(), "cannot be opened");
  using Entry = std::map<std::string, std::vector<std::string>>;  // allowed values by key of a part; no values: all
  std::vector<Entry> entries;
  try {
    const auto json = nlohmann::json::parse(in);
    for (const auto& rows : json.at("rows")) {
      Entry& entry = entries.emplace_back();
      for (const auto& [key, values] : rows.items()) {
        auto& allowed = entry[key];
        if (values == "all") continue;
        allowed = values.get<std::vector<std::string>>();
        if (allowed.empty()) throw BadFile(file.string(), key, "an empty list");
        if (key == "algorithm") allowed.insert(allowed.end(), external_algorithms.begin(), external_algorithms.end());
      }
    }
  } catch (const nlohmann::json::exception& e) {
    throw BadFile(file.string(), e.what());
  }
  return [entries = std::move(entries), named_only](std::string_view row) {
    const auto parts = row_name_parts(row);
    return std::ranges::any_of(entries, [&](const Entry& entry) {
      return std::ranges::all_of(parts, [&](const auto& part) {
        const auto found = entry.find(part.first);
        if (found == entry.end()) return false;
        if (found->second.empty()) return part.first != "algorithm" || !is_one_of(named_only, part.second);
        return is_one_of(found->second, part.second);
      });
    });
  };
}

}  // namespace sixdof::bench
