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

/// transfer(stream, value) writes a value to the pipe, or reads it there: texts and arrays behind their length.
void transfer(SeparateOutput& output, const std::size_t& value) { output.write(&value, sizeof(value)); }

void transfer(SeparateInput& input, std::size_t& value) { input.read(&value, sizeof(value)); }

template <class Container>
void transfer(SeparateOutput& output, const Container& values) {
  transfer(output, values.size());
  output.write(values.data(), values.size() * sizeof(typename Container::value_type));
}

/// A damaged process may state any length: what is there is read in blocks. Address space costs nothing.
template <class Container>
void transfer(SeparateInput& input, Container& values) {
  using T = typename Container::value_type;
  static_assert(std::is_same_v<T, Eigen::Vector3d> || std::is_trivially_copyable_v<T>);
  constexpr std::size_t k_block = (std::size_t{64} << 20) / sizeof(T);
  constexpr std::size_t k_most_reserved = (std::size_t{4} << 30) / sizeof(T);
  std::size_t left = 0;
  transfer(input, left);
  values.reserve(std::min(left, k_most_reserved));
  while (left > 0) {
    const std::size_t count = std::min(left, k_block), before = values.size();
    values.resize(before + count);
    input.read(values.data() + before, count * sizeof(T));
    left -= count;
  }
}

/// Mesh::build() looks at the values.
template <class Stream, class AnyFileMesh>
void transfer_mesh(Stream& stream, AnyFileMesh& mesh) {
  transfer(stream, mesh.vertices);
  transfer(stream, mesh.triangles);
  for (auto& repairs : mesh.repairs.forgiven.kinds) {
    transfer(stream, repairs.count);
    transfer(stream, repairs.first_place);
  }
  auto& notes = mesh.repairs.notes;
  std::size_t count = notes.size();
  transfer(stream, count);
  for (std::size_t i = 0; i < count; ++i) {
    if constexpr (std::is_same_v<Stream, SeparateInput>) notes.emplace_back();
    transfer(stream, notes[i]);
  }
}

static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(std::uint32_t));

/// Far more than intact files need. A small hostile file is stopped before it slows the machine down.
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

FileMesh read_by_assimp_separately(const Source& source, FileFrame frame) {
  const auto work = [&](SeparateOutput& output) {
    try {
      read_by_assimp(source, frame, [&](const FileMesh& surface) {
        output.write(&k_surface, 1);
        transfer_mesh(output, surface);
        output.finish();
      });
    } catch (const BadFile& e) {
      const std::string file = source.path.string() + ": ";
      output.write(&k_bad_file, 1);
      transfer(output, std::string(e.what()).substr(file.size()));
    }
  };
  FileMesh surface;
  std::string refusal;
  const auto receive = [&](SeparateInput& input) {
    char kind = k_surface;
    input.read(&kind, 1);
    kind == k_surface ? transfer_mesh(input, surface) : transfer(input, refusal);
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
