#include <sixdof/base/cache.h>

#include <cstdlib>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>
#include <sixdof/base/hdf5.h>

namespace sixdof {
namespace {

constexpr std::string_view k_format = "sixdof cache 1";

std::filesystem::path cache_directory() {
  const auto variable = [](const char* name) -> std::string {
    const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets variables meanwhile
    return value == nullptr ? "" : value;
  };
  if (const std::string own = variable("SIXDOF_CACHE"); own == "off")
    return {};
  else if (!own.empty())
    return own;
  if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return std::filesystem::path(xdg) / "sixdof";
  if (const std::string home = variable("HOME"); !home.empty()) return std::filesystem::path(home) / ".cache/sixdof";
  return {};
}

void add_text(ContentHash& hash, std::string_view text) {
  const std::uint64_t length = text.size();
  hash.add_values(std::span(&length, 1));
  hash.add_values(std::span(text.data(), text.size()));
}

std::string content_hash(const CacheEntry& entry) {
  ContentHash hash;
  for (const auto& [name, values] : entry.arrays()) {
    add_text(hash, name);
    const std::uint64_t type = values.index();
    hash.add_values(std::span(&type, 1));
    std::visit(
        [&](const auto& v) {
          const std::uint64_t length = v.size();
          hash.add_values(std::span(&length, 1));
          hash.add(std::as_bytes(std::span(v)));
        },
        values);
  }
  return hash.hex();
}

template <class T>
constexpr char k_type_letter = '?';
template <>
constexpr char k_type_letter<std::int32_t> = 'i';
template <>
constexpr char k_type_letter<std::uint32_t> = 'u';
template <>
constexpr char k_type_letter<std::uint64_t> = 'w';
template <>
constexpr char k_type_letter<float> = 'f';
template <>
constexpr char k_type_letter<double> = 'd';

template <class T>
void read_array(const hdf5::File& file, const std::string& name, CacheEntry& entry) {
  entry.put(name, file.read_values<T>("/" + name));
}

}  // namespace

void CacheEntry::refuse(const std::string& name) { throw BadFile("cache", name, "no such array of this type"); }

std::filesystem::path cache_file(std::string_view kind, std::string_view key) {
  const std::filesystem::path directory = cache_directory();
  if (directory.empty()) return {};
  ContentHash hash;
  add_text(hash, k_format);
  add_text(hash, key);
  return directory / (std::string(kind) + "-" + hash.hex() + ".h5");
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
        const std::string name = list.substr(begin, colon - begin);
        switch (list[colon + 1]) {
          case k_type_letter<std::int32_t>:
            read_array<std::int32_t>(file, name, entry);
            break;
          case k_type_letter<std::uint32_t>:
            read_array<std::uint32_t>(file, name, entry);
            break;
          case k_type_letter<std::uint64_t>:
            read_array<std::uint64_t>(file, name, entry);
            break;
          case k_type_letter<float>:
            read_array<float>(file, name, entry);
            break;
          case k_type_letter<double>:
            read_array<double>(file, name, entry);
            break;
          default:
            return std::nullopt;
        }
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
  const std::filesystem::path path = cache_file(kind, key);
  if (path.empty()) return false;
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  if (error) return false;
  try {
    AtomicFile target(path);
    {
      const hdf5::Session session;
      hdf5::File file = hdf5::File::create(target.temporary_path(), path);
      std::string list;
      for (const auto& [name, values] : entry.arrays()) {
        std::visit(
            [&, &array = name](const auto& v) {
              using T = typename std::decay_t<decltype(v)>::value_type;
              file.write_values<T>("/" + array, v);
              list += array + ":" + k_type_letter<T> + " ";
            },
            values);
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
