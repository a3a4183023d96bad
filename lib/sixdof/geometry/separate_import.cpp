// Assimp in a process of its own (base/separate_process.h): a file that makes it crash, recurse, loop or take all
// memory ends its own import. The surface comes back as bytes.
#include <algorithm>
#include <cstring>
#include <type_traits>

#include <sixdof/base/error.h>
#include <sixdof/base/separate_process.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

/// What the process gives: a surface, or the words of a BadFile.
constexpr char k_surface = 's', k_bad_file = 'b';

void append(std::string& bytes, std::size_t value) { append_little_endian(bytes, std::uint64_t{value}); }

void append(std::string& bytes, const std::string& text) {
  append(bytes, text.size());
  bytes += text;
}

void append(std::string& bytes, const FileRepairs& repairs) {
  append(bytes, repairs.count);
  append(bytes, repairs.first_place);
}

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  append(bytes, values.size());
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

std::string to_bytes(const Surface& surface) {
  std::string bytes(1, k_surface);
  bytes.reserve(surface.vertices.size() * sizeof(Eigen::Vector3d) + surface.triangles.size() * sizeof(Triangle) + 4096);
  append(bytes, surface.vertices);
  append(bytes, surface.triangles);
  for (const FileRepairs& of_kind : surface.repairs.forgiven.kinds) append(bytes, of_kind);
  append(bytes, surface.repairs.notes.size());
  for (const std::string& note : surface.repairs.notes) append(bytes, note);
  return bytes;
}

/// Reads what to_bytes() wrote. A damaged process may write anything: Mesh::build() looks at the values.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : left_(bytes) {}

  std::size_t number() {
    const std::string_view raw = take(sizeof(std::uint64_t));
    return load_bytes<std::uint64_t>(raw.data());
  }
  std::string text() { return std::string(take(number())); }
  FileRepairs repairs() {
    const std::size_t count = number();
    return {count, text()};
  }
  template <class T>
  std::vector<T> values() {
    const std::size_t count = number();
    if (count > left_.size() / sizeof(T)) throw SeparateFailure("gave a surface that is cut off");
    std::vector<T> result(count);
    const std::string_view raw = take(count * sizeof(T));
    if (count > 0) std::memcpy(static_cast<void*>(result.data()), raw.data(), raw.size());
    return result;
  }

 private:
  std::string_view take(std::size_t count) {
    if (count > left_.size()) throw SeparateFailure("gave a surface that is cut off");
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(count);
    return taken;
  }

  std::string_view left_;
};

static_assert(std::is_trivially_copyable_v<Triangle> && sizeof(Eigen::Vector3d) == 3 * sizeof(double));

Surface to_surface(std::string_view given) {
  Bytes bytes(given);
  Surface surface;
  surface.vertices = bytes.values<Eigen::Vector3d>();
  surface.triangles = bytes.values<Triangle>();
  for (FileRepairs& of_kind : surface.repairs.forgiven.kinds) of_kind = bytes.repairs();
  for (std::size_t n = bytes.number(); n > 0; --n) surface.repairs.notes.push_back(bytes.text());
  return surface;
}

/// Far more than files need that hold what they are about; a small hostile one is ended before it is felt.
SeparateLimits limits_for(std::size_t file_bytes) {
  constexpr std::size_t k_memory_per_byte = 200, k_least_memory = std::size_t{2} << 30;
  constexpr double k_least_s = 60.0, k_s_per_byte = 20e-6, k_waiting = 4.0;
  SeparateLimits limits;
  limits.memory_bytes = std::min(k_least_memory + k_memory_per_byte * file_bytes, default_memory_limit());
  limits.processor_s = k_least_s + k_s_per_byte * static_cast<double>(file_bytes);
  limits.wall_s = k_waiting * limits.processor_s;  // on a busy machine
  limits.result_bytes = limits.memory_bytes;
  return limits;
}

}  // namespace

Surface read_by_assimp_separately(const Source& source, FileFrame frame) {
  const auto work = [&] {
    try {
      return to_bytes(read_by_assimp(source, frame));
    } catch (const BadFile& e) {
      const std::string file = source.path.string() + ": ";
      return k_bad_file + std::string(e.what()).substr(file.size());
    }
  };
  try {
    const std::string given = run_separately(work, limits_for(source.bytes.size()));
    const std::string_view content = std::string_view(given).substr(std::min<std::size_t>(given.size(), 1));
    if (given.starts_with(k_bad_file)) source.fail(std::string(content));
    return to_surface(content);
  } catch (const SeparateFailure& e) {
    source.fail(std::string("assimp, which reads this format, ") + e.what());
  } catch (const BadFile&) {
    throw;
  } catch (const Error& e) {
    source.fail(std::string("cannot be read apart: ") + e.what());
  }
}

}  // namespace sixdof::loading
