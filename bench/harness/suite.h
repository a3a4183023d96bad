#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sixdof::bench {

/// A list of rows as data (bench/default_suite.json). A row belongs to it if one entry lists every part of the row's
/// name. "distance/algorithm:fcl-rss/pair:bunny/volume:05" needs an entry with "distance" under "query", "fcl-rss"
/// under "algorithm", and so on; the word "all" instead of a list allows everything. Parts without a colon behind the
/// first
/// ("II" of "scenario/II/algorithm:exact") are free.
class Suite {
 public:
  /// @param external_algorithms belong wherever an entry lists algorithms
  /// @throws BadFile
  static Suite read(const std::filesystem::path& file, const std::vector<std::string>& external_algorithms);

  bool contains(std::string_view row) const;

 private:
  /// Allowed values by the key of a part; no values: all.
  using Entry = std::map<std::string, std::vector<std::string>, std::less<>>;
  std::vector<Entry> entries_;
};

}  // namespace sixdof::bench
