#include "bench/harness/suite.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include "bench/common/rivals.h"

namespace sixdof::bench {
namespace {

constexpr const char* k_sample = "sample";

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
                 const std::vector<std::string>& named_only, const std::vector<std::string>& rivals) {
  std::ifstream in(file);
  if (!in) throw BadFile(file.string(), "cannot be opened");
  struct Entry {
    std::map<std::string, std::vector<std::string>> allowed;  // values by key of a part; no values: all
    std::size_t sample = std::numeric_limits<std::size_t>::max();
  };
  std::vector<Entry> entries;
  try {
    const auto json = nlohmann::json::parse(in);
    for (const auto& rows : json.at("rows")) {
      Entry& entry = entries.emplace_back();
      for (const auto& [key, values] : rows.items()) {
        if (key == k_sample) {
          if (!values.is_number_unsigned() || values == 0) throw BadFile(file.string(), key, "not a positive integer");
          entry.sample = values.get<std::size_t>();
          continue;
        }
        auto& allowed = entry.allowed[key];
        if (values == "all") continue;
        allowed = values.get<std::vector<std::string>>();
        if (allowed.empty()) throw BadFile(file.string(), key, "an empty list");
        if (key != "algorithm") continue;
        if (is_one_of(allowed, k_rivals)) allowed.insert(allowed.end(), rivals.begin(), rivals.end());
        allowed.insert(allowed.end(), external_algorithms.begin(), external_algorithms.end());
      }
    }
  } catch (const nlohmann::json::exception& e) {
    throw BadFile(file.string(), e.what());
  }
  return [entries = std::move(entries), named_only](std::string_view row) -> std::optional<std::size_t> {
    const auto parts = row_name_parts(row);
    const auto entry = std::ranges::find_if(entries, [&](const Entry& one) {
      return std::ranges::all_of(parts, [&](const auto& part) {
        const auto found = one.allowed.find(part.first);
        if (found == one.allowed.end()) return false;
        if (found->second.empty()) return part.first != "algorithm" || !is_one_of(named_only, part.second);
        return is_one_of(found->second, part.second);
      });
    });
    if (entry == entries.end()) return {};
    return entry->sample;
  };
}

}  // namespace sixdof::bench
