#pragma once

// What the readers and writers of mesh files share; only files of lib/sixdof/geometry include this.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>

namespace sixdof::loading {

/// The extension of a file's name with its dot, in lower case: ".ply".
std::string lower_case_extension(const std::filesystem::path& file);

/// A file in memory.
struct Source {
  std::filesystem::path path;
  std::string bytes;

  /// Throws a BadFile that names the file. @param place in the file: "line 7", "face 3".
  [[noreturn]] void fail(const std::string& cause) const;
  [[noreturn]] void fail(const std::string& place, const std::string& cause) const;
};

/// Reads a regular file whole. @throws BadFile
Source read_source(const std::filesystem::path& file);

/// The value of type T stored at `at` in the given byte order; `at` need not be aligned.
template <class T>
T load_bytes(const char* at, std::endian order = std::endian::little) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), at, sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// Appends the bytes of `value`, lowest first.
template <class T>
void append_little_endian(std::string& bytes, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native != std::endian::little) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

/// What a reader returns: indices are in range and coordinates finite, nothing is welded yet.
struct Surface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  MeshRepairs repairs;
};

/// Counts one repair. @param place of what was repaired in the file.
void count_repair(FileRepairs& repairs, const std::string& place);

/// Triangulates a polygon of vertices of the surface, and counts it if it is other than simple.
/// @param place names the polygon's place in the file; called only if it is needed
/// @throws BadFile if the polygon is too large to be triangulated.
void add_polygon(const Source& source, std::span<const std::uint32_t> corners,
                 const std::function<std::string()>& place, Surface& surface);

/// The first byte of a text: behind a UTF-8 byte order mark if there is one.
std::size_t text_begin(std::string_view bytes);

/// @throws BadFile if the file begins with the byte order mark of UTF-16.
void refuse_utf16(const Source& source);

/// Reads the lines of a text file that hold data, as words separated by blanks. Numbers are read by std::from_chars,
/// which no locale changes. Lines end in LF or CR LF, the last one also at the end of the file; a UTF-8 byte order mark
/// at the file's start is skipped.
class TextLines {
 public:
  struct Syntax {
    char comment = '\0';        ///< Starts a comment that lasts to the end of the line; 0: there are none.
    bool continuation = false;  ///< A backslash at the end of a line joins the next one to it.
  };

  /// Starts at byte `begin` of the source, which is on line `line` (from 1).
  TextLines(const Source& source, Syntax syntax, std::size_t begin = 0, std::size_t line = 1);

  /// Advances to the next line that is not blank; false at the end of the file.
  bool next();

  const std::vector<std::string_view>& words() const { return words_; }
  std::size_t size() const { return words_.size(); }

  // Each of these throws a BadFile that names the line if a word is not what it reads.

  /// Word i as a finite number.
  double number(std::size_t i) const;
  /// Words first .. first + 2 as a point.
  Eigen::Vector3d point(std::size_t first) const { return {number(first), number(first + 1), number(first + 2)}; }
  /// A word as a signed integer.
  std::int64_t integer(std::string_view word) const;
  std::int64_t integer(std::size_t i) const { return integer(words_[i]); }

  std::size_t line() const { return line_; }
  std::string place() const;  ///< The current line, for messages: "line 7".
  /// Bytes behind the current line.
  std::size_t remaining() const { return text_.size() - next_; }
  /// Byte behind the current line.
  std::size_t position() const { return next_; }

  [[noreturn]] void fail(const std::string& cause) const;

  /// Fails unless the file ends here.
  void expect_end();

 private:
  bool read_line();
  template <class T>
  T parse(std::string_view word, const char* range, const char* kind) const;

  const Source& source_;
  std::string_view text_;
  Syntax syntax_;
  std::size_t next_;
  std::size_t line_;       // of the first line of words_
  std::size_t next_line_;  // of next_
  std::vector<std::string_view> words_;
};

/// What is done with the unit and the axes that a file states (load.h).
enum class FileFrame {
  metres,
  as_stored,
  y_up
};

// These formats are not left to assimp (5.2): it holds coordinates in single precision only, does not return from a PLY
// file without end_header, accepts a truncated OFF file, and knows neither the instances, nor the integer coordinates
// of glTF.
Surface read_gltf(const Source& source);
Surface read_obj(const Source& source);
Surface read_off(const Source& source);
Surface read_ply(const Source& source);
Surface read_stl(const Source& source);

/// Whether assimp has a reader for files with this extension.
bool assimp_reads(const std::string& extension);

/// Reads a file of any other format by assimp, as load.h says. All meshes of the scene become one surface. A damaged
/// file may crash it, or make it never return.
/// @throws BadFile
Surface read_by_assimp(const Source& source, FileFrame frame);

/// The same surface, read in a process of its own. @throws BadFile also for what ends that process
Surface read_by_assimp_separately(const Source& source, FileFrame frame);

}  // namespace sixdof::loading
