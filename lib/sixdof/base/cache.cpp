#include <sixdof/base/cache.h>

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <mutex>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>
#include <sixdof/base/hdf5.h>

namespace sixdof {
namespace {

constexpr std::string_view k_format = "sixdof cache 1";

std::filesystem::path cache_directory() {
  const auto variable = [](const char* name) -> std::string {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
  };
  if (const std::string own = variable("SIXDOF_CACHE"); !own.empty()) {
    return own == "off" ? std::filesystem::path() : std::filesystem::path(own);
  }
  if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return std::filesystem::path(xdg) / "sixdof";
  if (const std::string home = variable("HOME"); !home.empty()) return std::filesystem::path(home) / ".cache/sixdof";
  return {};
}

/// Why a folder that is there is not used; empty if it may be.
std::string refusal_of(const std::filesystem::path& folder) {
  struct stat state = {};
  try {
    if (::stat(follow_links(folder).c_str(), &state) != 0) return {};
  } catch (const BadFile& e) {
    return e.what();
  }
  const auto refuse = [&](const std::string& why) {
    return fmt::format("{}: is not used as cache: {}", folder.string(), why);
  };
  if (state.st_uid != ::geteuid()) return refuse(fmt::format("it belongs to another user (uid {})", state.st_uid));
  if ((state.st_mode & (S_IWGRP | S_IWOTH)) != 0) {
    return refuse(fmt::format("others can write it (mode {:04o}); chmod go-w makes it one", state.st_mode & 07777));
  }
  return {};
}

/// Words of the first refusal, for cache_refusal().
struct Refusal {
  std::mutex mutex;
  std::string words;
};

Refusal& refusal() {
  static Refusal first;
  return first;
}

/// Adds the number of values before them.
template <class T>
void add_sized(ContentHash& hash, std::span<const T> values) {
  const std::uint64_t length = values.size();
  hash.add_values(std::span(&length, 1));
  hash.add_values(values);
}

std::string content_hash(const CacheEntry& entry) {
  ContentHash hash;
  for (const auto& [name, values] : entry.arrays()) {
    add_sized(hash, std::span(name));
    const std::uint64_t type = values.index();
    hash.add_values(std::span(&type, 1));
    std::visit([&](const auto& v) { add_sized(hash, std::span(v)); }, values);
  }
  return hash.hex();
}

/// Names the types of arrays in a file, in the order of CacheEntry::Values.
constexpr std::string_view k_type_letters = "iuwfd";

/// @return whether `letter` names a type
template <std::size_t type = 0>
bool read_array(const hdf5::File& file, const std::string& name, char letter, CacheEntry& entry) {
  if constexpr (type == k_type_letters.size()) {
    return false;
  } else {
    if (letter != k_type_letters[type]) return read_array<type + 1>(file, name, letter, entry);
    using Array = std::variant_alternative_t<type, CacheEntry::Values>;
    entry.put(name, file.read_values<typename Array::value_type>("/" + name));
    return true;
  }
}

}  // namespace

void CacheEntry::refuse(const std::string& name) { throw BadFile("cache", name, "no such array of this type"); }

std::filesystem::path cache_file(std::string_view kind, std::string_view key) {
  const std::filesystem::path directory = cache_directory();
  if (directory.empty()) return {};
  if (const std::string words = refusal_of(directory); !words.empty()) {
    const std::scoped_lock lock(refusal().mutex);
    refusal().words = words;
    return {};
  }
  ContentHash hash;
  add_sized(hash, std::span(k_format));
  add_sized(hash, std::span(key));
  return directory / (std::string(kind) + "-" + hash.hex() + ".h5");
}

std::filesystem::path writable_cache_file(std::string_view kind, std::string_view key) {
  std::filesystem::path file = cache_file(kind, key);
  if (file.empty()) return file;
  try {
    const std::filesystem::path above = file.parent_path().parent_path();
    if (!above.empty()) std::filesystem::create_directories(above);  // empty: a folder of the working directory
    // Whatever the umask is: a folder that a group can write would be refused the next time.
    if (::mkdir(file.parent_path().c_str(), S_IRWXU) == 0) file = cache_file(kind, key);
    check_writable(file);
    // Of a writer that was killed. One on another machine may lose its file by this, and then keeps nothing.
    remove_stale_partials(file);
  } catch (const std::exception&) {
    return {};
  }
  return file;
}

std::string cache_refusal() {
  const std::scoped_lock lock(refusal().mutex);
  return refusal().words;
}

std::optional<CacheEntry> load_cached(std::string_view kind, std::string_view key) {
  const std::filesystem::path path = cache_file(kind, key);
  std::error_code error;
  if (path.empty() || !std::filesystem::is_regular_file(path, error)) return std::nullopt;
  try {
    CacheEntry entry;
    std::string expected;
    {
      const hdf5::Session session;
      const hdf5::File file = hdf5::File::open(path);
      if (file.read_string("/", "format") != k_format || file.read_string("/", "key") != key) return std::nullopt;
      expected = file.read_string("/", "content");
      // "a:f b:i " names the arrays and their types.
      const std::string list = file.read_string("/", "arrays");
      for (std::size_t begin = 0; begin < list.size();) {
        const std::size_t colon = list.find(':', begin);
        if (colon == std::string::npos || colon + 2 >= list.size()) return std::nullopt;
        if (!read_array(file, list.substr(begin, colon - begin), list[colon + 1], entry)) return std::nullopt;
        begin = colon + 3;
      }
    }
    if (content_hash(entry) != expected) return std::nullopt;
    return entry;
  } catch (const Error&) {
    return std::nullopt;
  }
}

bool store_cached(std::string_view kind, std::string_view key, const CacheEntry& entry) {
  const std::filesystem::path path = writable_cache_file(kind, key);
  if (path.empty()) return false;
  try {
    AtomicFile target(path);
    {
      const hdf5::Session session;
      hdf5::File file = hdf5::File::create(target);
      std::string list;
      for (const auto& [name, values] : entry.arrays()) {
        const std::string object = "/" + name;
        std::visit([&](const auto& v) { file.write_values<typename std::decay_t<decltype(v)>::value_type>(object, v); },
                   values);
        list += name + ":" + k_type_letters[values.index()] + " ";
      }
      file.write_attribute("/", "format", std::string(k_format));
      file.write_attribute("/", "key", std::string(key));
      file.write_attribute("/", "arrays", list);
      file.write_attribute("/", "content", content_hash(entry));
      file.close();
    }
    target.commit();
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace sixdof
