#include "bench/harness/suite.h"

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>

namespace sixdof::bench {
namespace {

constexpr const char* k_query = "query";
constexpr const char* k_algorithm = "algorithm";

}  // namespace

Suite Suite::read(const std::filesystem::path& file, const std::vector<std::string>& external_algorithms) {
  std::ifstream in(file);
  if (!in) throw BadFile(file.string(), "cannot be opened");
  Suite suite;
  try {
    const auto json = nlohmann::json::parse(in);
    for (const auto& rows : json.at("rows")) {
      Entry entry;
      for (const auto& [key, values] : rows.items()) {
        auto& allowed = entry[key];
        if (values == "all") continue;
        allowed = values.get<std::vector<std::string>>();
        if (allowed.empty()) throw BadFile(file.string(), key, "an empty list");
        if (key == k_algorithm) allowed.insert(allowed.end(), external_algorithms.begin(), external_algorithms.end());
      }
      suite.entries_.push_back(std::move(entry));
    }
  } catch (const nlohmann::json::exception& e) {
    throw BadFile(file.string(), e.what());
  }
  return suite;
}

bool Suite::contains(std::string_view row) const {
  const auto allows = [](const Entry& entry, std::string_view key, std::string_view value) {
    const auto found = entry.find(key);
    if (found == entry.end()) return false;
    return found->second.empty() || std::ranges::find(found->second, value) != found->second.end();
  };
  return std::ranges::any_of(entries_, [&](const Entry& entry) {
    std::size_t slash = row.find('/');
    if (!allows(entry, k_query, row.substr(0, slash))) return false;
    while (slash != std::string_view::npos) {
      const std::size_t begin = slash + 1;
      slash = row.find('/', begin);
      const std::string_view part = row.substr(begin, slash == std::string_view::npos ? slash : slash - begin);
      const std::size_t colon = part.find(':');
      if (colon == std::string_view::npos) continue;
      if (!allows(entry, part.substr(0, colon), part.substr(colon + 1))) return false;
    }
    return true;
  });
}

}  // namespace sixdof::bench
