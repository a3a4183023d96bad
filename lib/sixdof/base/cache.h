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

/// Arrays of numbers by name: the content of one file of the cache.
///
/// The cache keeps prepared structures on disk. An entry is found by its kind ("vps-voxelmap") and its key: a text that
/// names everything the content depends on (hash of the mesh, parameters, versions of format and algorithm). Entries
/// are HDF5 files in $SIXDOF_CACHE; else $XDG_CACHE_HOME/sixdof; else $HOME/.cache/sixdof. Nothing is kept if
/// SIXDOF_CACHE is "off" or none of the three is set. The directory may be deleted at any time, and processes may share
/// it. One that belongs to another user, or that others can write, is not used: cache_refusal() says so.
///
/// The cache does not throw. An entry that is missing, damaged or of another key is not found; one that cannot be
/// written is not kept.
class CacheEntry {
 public:
  using Values = std::variant<std::vector<std::int32_t>, std::vector<std::uint32_t>, std::vector<std::uint64_t>,
                              std::vector<float>, std::vector<double>>;

  /// @param name consists of a-z, 0-9 and '_'
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

/// The same, where a file can be written: the directory is there. Empty if nothing can be kept.
std::filesystem::path writable_cache_file(std::string_view kind, std::string_view key);

/// One line that says why the directory is not used, if this process has asked for an entry and was refused; else
/// empty. For programs to print.
std::string cache_refusal();

/// The entry as it was stored, checked against its content hash; nothing if there is none.
std::optional<CacheEntry> load_cached(std::string_view kind, std::string_view key);

/// Stores an entry, replacing an older one; makes the directory if needed. @return whether it was stored
bool store_cached(std::string_view kind, std::string_view key, const CacheEntry& entry);

}  // namespace sixdof
