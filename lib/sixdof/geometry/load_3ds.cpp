#include <fmt/format.h>

#include <sixdof/geometry/assimp_import.h>
#include <sixdof/geometry/bytes.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

// A 3DS file is a tree of chunks: a number (2 bytes), a length (4 bytes, these 6 included), then data and chunks.
constexpr std::uint16_t k_file = 0x4D4D;
constexpr std::uint16_t k_editor = 0x3D3D;
constexpr std::uint16_t k_object = 0x4000;  // name, then chunks
constexpr std::uint16_t k_mesh = 0x4100;
constexpr std::uint16_t k_vertices = 0x4110;  // count (2 bytes), then three floats each
constexpr std::uint16_t k_faces = 0x4120;  // count (2 bytes), then three indices and flags (2 bytes each), then chunks
constexpr std::size_t k_chunk_header = 6;
constexpr std::size_t k_vertex_bytes = 12;
constexpr std::size_t k_face_bytes = 8;

struct Chunk {
  std::uint16_t id;
  std::size_t begin, end;  // of its contents
};

void append_chunk(std::string& bytes, std::uint16_t id, const std::string& contents) {
  append_little_endian(bytes, id);
  append_little_endian(bytes, static_cast<std::uint32_t>(k_chunk_header + contents.size()));
  bytes += contents;
}

/// Checks the chunks that hold geometry and writes them anew, without anything else: no materials, no key framer (whose
/// transforms assimp would apply in single precision, though the vertices are stored in world coordinates already).
class Checker {
 public:
  explicit Checker(const Source& source) : source_(source) {}

  /// A file of the geometry alone.
  std::string rewrite() {
    const Chunk file = chunk_at(0, source_.bytes.size());
    if (file.id != k_file) source_.fail("byte 0", "is no 3DS file");
    if (file.end != source_.bytes.size()) {
      source_.fail("byte 0", fmt::format("the file's chunk ends at byte {} of {}", file.end, source_.bytes.size()));
    }
    std::string objects;
    for_each(file.begin, file.end, [&](const Chunk& editor) {
      if (editor.id != k_editor) return;
      for_each(editor.begin, editor.end, [&](const Chunk& object) {
        if (object.id == k_object) add_object(object, objects);
      });
    });
    std::string editor;
    append_chunk(editor, k_editor, objects);
    std::string bytes;
    append_chunk(bytes, k_file, editor);
    return bytes;
  }

  std::size_t triangles() const { return triangles_; }

 private:
  Chunk chunk_at(std::size_t at, std::size_t end) const {
    const std::string place = fmt::format("byte {}", at);
    if (end - at < k_chunk_header) source_.fail(place, "the file ends within a chunk's header");
    const auto length = load_little_endian<std::uint32_t>(source_.bytes.data() + at + 2);
    if (length < k_chunk_header || length > end - at) {
      source_.fail(place, fmt::format("a chunk of {} bytes where {} are left", length, end - at));
    }
    return {load_little_endian<std::uint16_t>(source_.bytes.data() + at), at + k_chunk_header, at + length};
  }

  template <class Visit>
  void for_each(std::size_t begin, std::size_t end, Visit visit) const {
    while (begin < end) {
      const Chunk chunk = chunk_at(begin, end);
      visit(chunk);
      begin = chunk.end;
    }
  }

  void add_object(const Chunk& object, std::string& objects) {
    const std::size_t zero = source_.bytes.find('\0', object.begin);
    if (zero == std::string::npos || zero >= object.end) {
      source_.fail(fmt::format("byte {}", object.begin), "an object's name has no end");
    }
    const std::string name = fmt::format("object {}", objects_++);
    for_each(zero + 1, object.end, [&](const Chunk& mesh) {
      if (mesh.id == k_mesh) add_mesh(mesh, name, objects);
    });
  }

  void add_mesh(const Chunk& mesh, const std::string& name, std::string& objects) {
    std::string vertices;
    std::string faces;
    std::size_t vertex_count = 0;
    std::size_t face_count = 0;
    for_each(mesh.begin, mesh.end, [&](const Chunk& part) {
      if (part.id == k_vertices) {
        if (!vertices.empty()) source_.fail(name, "has two lists of vertices");
        vertex_count = count_of(part, name, "vertices", k_vertex_bytes, true);
        vertices = source_.bytes.substr(part.begin, 2 + vertex_count * k_vertex_bytes);
      } else if (part.id == k_faces) {
        if (!faces.empty()) source_.fail(name, "has two lists of faces");
        face_count = count_of(part, name, "faces", k_face_bytes, false);
        faces = source_.bytes.substr(part.begin, 2 + face_count * k_face_bytes);
      }
    });
    if (face_count == 0) return;
    // Assimp would put the last vertex in the place of an index out of range.
    for (std::size_t i = 0; i < 3 * face_count; ++i) {
      const auto v = load_little_endian<std::uint16_t>(faces.data() + 2 + (i / 3) * k_face_bytes + 2 * (i % 3));
      if (v >= vertex_count) source_.fail(name, fmt::format("face {}: vertex index {} of {}", i / 3, v, vertex_count));
    }
    triangles_ += face_count;
    std::string parts;
    append_chunk(parts, k_vertices, vertices);
    append_chunk(parts, k_faces, faces);
    std::string object = name + '\0';
    append_chunk(object, k_mesh, parts);
    append_chunk(objects, k_object, object);
  }

  /// Counts have 16 bits: a writer that was given more than 65,535 leaves a count that does not match the length.
  std::size_t count_of(const Chunk& part, const std::string& name, const char* what, std::size_t bytes_each,
                       bool fills_chunk) const {
    const std::size_t room = part.end - part.begin;
    if (room < 2) source_.fail(name, fmt::format("the count of {} is missing", what));
    const std::size_t count = load_little_endian<std::uint16_t>(source_.bytes.data() + part.begin);
    const std::size_t needed = 2 + count * bytes_each;
    if (needed > room || (fills_chunk && needed != room)) {
      source_.fail(name, fmt::format("{} {} take {} bytes, but the chunk has {}", count, what, needed, room));
    }
    return count;
  }

  const Source& source_;
  std::size_t objects_ = 0;
  std::size_t triangles_ = 0;
};

}  // namespace

Surface read_3ds(const Source& source) {
  Checker checker(source);
  const std::string bytes = checker.rewrite();
  if (checker.triangles() == 0) source.fail("no triangles");
  return import_by_assimp(
      source, {.format = "3ds", .bytes = bytes, .apply_transforms = false, .triangles = checker.triangles()});
}

}  // namespace sixdof::loading
