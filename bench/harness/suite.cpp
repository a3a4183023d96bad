#include "bench/harness/suite.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/query/variant.h>
#include "bench/common/rivals.h"

namespace sixdof::bench {
namespace {

constexpr const char* k_sample = "sample";
constexpr const char* k_settings = "settings";
constexpr const char* k_scenario = "scenario";

/// The parts of a row's name by their keys: "collide/algorithm:exact/pair:ship" is {"query", "collide"}, {"algorithm",
/// "exact"}, {"pair", "ship"}. Of parts without a colon behind the first only a scenario has a key: "scenario".
std::map<std::string, std::string> row_name_parts(std::string_view name) {
  std::map<std::string, std::string> parts;
  std::istringstream words{std::string(name)};
  std::getline(words, parts["query"], '/');
  for (std::string word; std::getline(words, word, '/');) {
    const auto colon = word.find(':');
    if (colon != std::string::npos) {
      parts[word.substr(0, colon)] = word.substr(colon + 1);
    } else if (parts["query"] == k_scenario) {
      parts[k_scenario] = word;
    }
  }
  return parts;
}

bool is_one_of(const std::vector<std::string>& list, const std::string& word) {
  return std::ranges::find(list, word) != list.end();
}

/// Values by key of a part; no values: all.
struct Entry {
  std::map<std::string, std::vector<std::string>> allowed;
  std::size_t sample = std::numeric_limits<std::size_t>::max();
  std::vector<std::string> settings;  ///< Of the variants that it lists, "parameter=value"; empty: any.

  bool takes_algorithm(const std::string& name, const std::vector<std::string>& list) const {
    const std::string base = base_name(name);
    if (!settings.empty()) return is_one_of(list, base) && name == variant_name(base, settings);
    return is_one_of(list, name) || is_one_of(list, base);
  }
};

/// Names of the variants that the list itself makes.
std::set<std::string> variants_of(const std::vector<Entry>& entries) {
  std::set<std::string> names;
  for (const Entry& entry : entries) {
    if (entry.settings.empty()) continue;
    for (const std::string& algorithm : entry.allowed.at("algorithm")) {
      names.insert(variant_name(algorithm, entry.settings));
    }
  }
  return names;
}

/// A setting's value, as the command line has it. @throws BadFile
std::string text_of(const std::filesystem::path& file, const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number()) throw BadFile(file.string(), k_settings, "neither a number nor a text");
  return value.dump();
}

Entry entry_of(const std::filesystem::path& file, const nlohmann::ordered_json& rows) {
  Entry entry;
  for (const auto& [key, values] : rows.items()) {
    if (key == k_sample) {
      if (!values.is_number_unsigned() || values == 0) throw BadFile(file.string(), key, "not a positive integer");
      entry.sample = values.get<std::size_t>();
    } else if (key == k_settings) {
      for (const auto& [name, value] : values.items()) {
        entry.settings.push_back(name + "=" + text_of(file, value));
      }
      if (entry.settings.empty()) throw BadFile(file.string(), key, "has no parameter");
    } else {
      auto& allowed = entry.allowed[key];
      if (values == "all") continue;
      allowed = values.get<std::vector<std::string>>();
      if (allowed.empty()) throw BadFile(file.string(), key, "an empty list");
    }
  }
  if (!entry.settings.empty() && entry.allowed["algorithm"].empty()) {
    throw BadFile(file.string(), k_settings, "needs an algorithm in the same entry");
  }
  return entry;
}

std::vector<Entry> entries_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw BadFile(file.string(), "cannot be opened");
  std::vector<Entry> entries;
  try {
    const auto json = nlohmann::ordered_json::parse(in);
    for (const auto& rows : json.at("rows")) entries.push_back(entry_of(file, rows));
  } catch (const nlohmann::json::exception& e) {
    throw BadFile(file.string(), e.what());
  }
  return entries;
}

}  // namespace

std::vector<VariantRequest> suite_variants(const std::filesystem::path& file) {
  std::vector<VariantRequest> variants;
  for (const Entry& entry : entries_of(file)) {
    if (entry.settings.empty()) continue;
    for (const std::string& algorithm : entry.allowed.at("algorithm")) {
      const auto is_same = [&](const VariantRequest& each) {
        return each.algorithm == algorithm && each.assignments == entry.settings;
      };
      if (std::ranges::none_of(variants, is_same)) variants.push_back({algorithm, entry.settings});
    }
  }
  return variants;
}

Suite read_suite(const std::filesystem::path& file, const std::vector<std::string>& external_algorithms,
                 const std::vector<std::string>& named_only, const std::vector<std::string>& rivals) {
  std::vector<Entry> entries = entries_of(file);
  for (Entry& entry : entries) {
    const auto found = entry.allowed.find("algorithm");
    if (found == entry.allowed.end() || found->second.empty()) continue;
    auto& allowed = found->second;
    if (is_one_of(allowed, k_rivals)) allowed.insert(allowed.end(), rivals.begin(), rivals.end());
    allowed.insert(allowed.end(), external_algorithms.begin(), external_algorithms.end());
  }
  std::set<std::string> variants = variants_of(entries);
  return [entries = std::move(entries), variants = std::move(variants),
          named_only](std::string_view row) -> std::optional<std::size_t> {
    const auto parts = row_name_parts(row);
    const auto entry = std::ranges::find_if(entries, [&](const Entry& one) {
      return std::ranges::all_of(parts, [&](const auto& part) {
        const auto found = one.allowed.find(part.first);
        if (found == one.allowed.end()) return part.first == k_scenario;
        const bool is_algorithm = part.first == "algorithm";
        if (is_algorithm && one.settings.empty() && variants.contains(part.second)) return false;
        if (found->second.empty()) return !is_algorithm || !is_one_of(named_only, part.second);
        return is_algorithm ? one.takes_algorithm(part.second, found->second) : is_one_of(found->second, part.second);
      });
    });
    if (entry == entries.end()) return {};
    return entry->sample;
  };
}

}  // namespace sixdof::bench
