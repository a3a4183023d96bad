// Assimp in a process of its own (base/separate_process.h): a file that makes it crash, recurse, loop or take all
// memory ends its own import. The surface comes back through a pipe.
#include <algorithm>
#include <type_traits>

#include <sixdof/base/error.h>
#include <sixdof/base/separate_process.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

/// What the process gives: a surface, or the words of a BadFile.
constexpr char k_surface = 's', k_bad_file = 'b';

// Numbers, texts and arrays, each behind its length.

void put(SeparateOutput& output, std::size_t value) { output.write(&value, sizeof(value)); }

void put(SeparateOutput& output, const std::string& text) {
  put(output, text.size());
  output.write(text.data(), text.size());
}

void put(SeparateOutput& output, const FileRepairs& repairs) {
  put(output, repairs.count);
  put(output, repairs.first_place);
}

template <class T>
void put(SeparateOutput& output, const std::vector<T>& values) {
  put(output, values.size());
  output.write(values.data(), values.size() * sizeof(T));
}

void put(SeparateOutput& output, const Surface& surface) {
  put(output, surface.vertices);
  put(output, surface.triangles);
  for (const FileRepairs& repairs : surface.repairs.forgiven.kinds) put(output, repairs);
  put(output, surface.repairs.notes.size());
  for (const std::string& note : surface.repairs.notes) put(output, note);
}

std::size_t take_number(SeparateInput& input) {
  std::size_t value = 0;
  input.read(&value, sizeof(value));
  return value;
}

/// A damaged process may state any length: what is there is read in blocks. Address space costs nothing.
template <class Container>
void take(SeparateInput& input, Container& values) {
  using T = typename Container::value_type;
  static_assert(std::is_same_v<T, Eigen::Vector3d> || std::is_trivially_copyable_v<T>);
  constexpr std::size_t k_block = (std::size_t{64} << 20) / sizeof(T);
  std::size_t left = take_number(input);
  constexpr std::size_t k_most_reserved = (std::size_t{4} << 30) / sizeof(T);
  values.reserve(std::min(left, k_most_reserved));
  while (left > 0) {
    const std::size_t count = std::min(left, k_block), before = values.size();
    values.resize(before + count);
    input.read(values.data() + before, count * sizeof(T));
    left -= count;
  }
}

void take(SeparateInput& input, FileRepairs& repairs) {
  repairs.count = take_number(input);
  take(input, repairs.first_place);
}

/// Mesh::build() looks at the values.
void take(SeparateInput& input, Surface& surface) {
  take(input, surface.vertices);
  take(input, surface.triangles);
  for (FileRepairs& repairs : surface.repairs.forgiven.kinds) take(input, repairs);
  for (std::size_t left = take_number(input); left > 0; --left) take(input, surface.repairs.notes.emplace_back());
}

static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(std::uint32_t));

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
  const auto work = [&](SeparateOutput& output) {
    try {
      read_by_assimp(source, frame, [&](const Surface& surface) {
        output.write(&k_surface, 1);
        put(output, surface);
        output.finish();
      });
    } catch (const BadFile& e) {
      const std::string file = source.path.string() + ": ";
      output.write(&k_bad_file, 1);
      put(output, std::string(e.what()).substr(file.size()));
    }
  };
  Surface surface;
  std::string refusal;
  const auto receive = [&](SeparateInput& input) {
    char kind = k_surface;
    input.read(&kind, 1);
    kind == k_surface ? take(input, surface) : take(input, refusal);
  };
  try {
    run_separately(work, receive, limits_for(source.bytes.size()));
  } catch (const SeparateFailure& e) {
    source.fail(std::string("assimp, which reads this format, ") + e.what());
  } catch (const Error& e) {
    source.fail(std::string("cannot be read in a process of its own: ") + e.what());
  }
  if (!refusal.empty()) source.fail(refusal);
  return surface;
}

}  // namespace sixdof::loading
