#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace sixdof {

/// Prepared structures kept on disk, so that what was built once is not built again.
///
/// An entry is found by its kind ("vps-voxelmap") and its key: a text that names everything the content depends on
/// (content hash of the mesh, settings, version of the format and of the algorithm that builds it). Entries are HDF5
/// files in one directory: environment SIXDOF_CACHE; else $XDG_CACHE_HOME/sixdof; else $HOME/.cache/sixdof. With
/// SIXDOF_CACHE=off, or no such variable at all, nothing is kept. Deleting the directory is always safe.
///
/// The cache never fails: an entry that is missing, damaged or of another key is not found, and one that cannot be
/// written is not kept. Files appear whole or not at all, so processes may share the directory.
class CacheEntry {
 public:
  using Values = std::variant<std::vector<std::int32_t>, std::vector<std::uint32_t>, std::vector<std::uint64_t>,
                              std::vector<float>, std::vector<double>>;

  /// @param name a-z, 0-9 and '_'
  template <class T>
  void put(const std::string& name, std::vector<T> values) {
    arrays_[name] = std::move(values);
  }

  /// Moves an array out. @throws BadFile if there is none of this name and type.
  template <class T>
  std::vector<T> take(const std::string& name) {
    const auto found = arrays_.find(name);
    if (found == arrays_.end() || !std::holds_alternative<std::vector<T>>(found->second)) refuse(name);
    return std::get<std::vector<T>>(std::move(found->second));
  }

  const std::map<std::string, Values>& arrays() const { return arrays_; }

 private:
  [[noreturn]] static void refuse(const std::string& name);
  std::map<std::string, Values> arrays_;
};

/// The file of an entry; empty if nothing is kept.
std::filesystem::path cache_file(std::string_view kind, std::string_view key);

/// The entry as it was stored, every byte checked against its content hash; nothing if there is none.
std::optional<CacheEntry> load_cached(std::string_view kind, std::string_view key);

/// Keeps an entry, replacing what was there; makes the directory if needed. @return whether it was kept
bool store_cached(std::string_view kind, std::string_view key, const CacheEntry& entry);

}  // namespace sixdof
