#pragma once

// What the readers and writers of mesh files share; only files of lib/sixdof/geometry and their tests include this.

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
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/load.h>
#include <sixdof/geometry/raw_mesh.h>

namespace sixdof::loading {

/// The extension of a file's name with its dot, in lower case: ".ply".
std::string lower_case_extension(const std::filesystem::path& file);

/// A file in memory.
struct Source {
  std::filesystem::path path;
  std::string bytes;
  LoadOptions options = {};

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

/// A vertex that no face can use.
struct UnusableVertex {
  std::uint32_t vertex;
  std::size_t line;     ///< Of a text; 0 in a binary file.
  double weight = 1.0;  ///< Of an OBJ vertex; 1: the coordinates are not finite.
};

/// What a reader returns: indices are in range, coordinates of triangles finite, nothing is welded yet.
struct FileMesh : RawMesh {
  MeshRepairs repairs;
  std::vector<UnusableVertex> unusable;  ///< By vertex.

  /// @param line of a text; 0 in a binary file
  void add_vertex(const Eigen::Vector3d& p, std::size_t line) {
    if (!p.allFinite()) unusable.push_back({static_cast<std::uint32_t>(vertices.size()), line});
    vertices.push_back(p);
  }
};

/// For a face with a corner that is not finite: counts it if the options say so. @throws BadFile otherwise
/// @param face, corner: their places in the file
void drop_face(const Source& source, FileMesh& surface, const std::function<std::string()>& face,
               const std::string& corner, const Eigen::Vector3d& p);

/// Triangulates a polygon of vertices of the surface, and counts it if it is other than simple. One of fewer than three
/// corners is skipped and counted.
/// @param place names the polygon's place in the file; called only if it is needed
/// @throws BadFile if the polygon is too large to be triangulated, or has an unusable corner.
void add_polygon(const Source& source, std::span<const std::uint32_t> corners,
                 const std::function<std::string()>& place, FileMesh& surface);

/// Polygons that stand before their vertices in the file, kept until these are read.
class LatePolygons {
 public:
  bool empty() const { return polygons_.empty(); }
  /// @param line, number: say where it is in the file
  void add(std::span<const std::uint32_t> corners, std::size_t line, std::uint64_t number) {
    polygons_.push_back({corners_.size(), line, number});
    corners_.insert(corners_.end(), corners.begin(), corners.end());
  }
  /// visit(corners, line, number) for each, in their order.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      const std::size_t end = i + 1 < polygons_.size() ? polygons_[i + 1].begin : corners_.size();
      visit(std::span(corners_).subspan(polygons_[i].begin, end - polygons_[i].begin), polygons_[i].line,
            polygons_[i].number);
    }
  }

 private:
  struct Polygon {
    std::size_t begin, line;
    std::uint64_t number;
  };
  std::vector<std::uint32_t> corners_;
  std::vector<Polygon> polygons_;
};

/// A name in which %20 and the like stand for bytes.
std::string decode_percent(const std::string& name);

/// Whether there is nothing but white space.
bool is_blank_text(std::string_view text);

/// The first byte of a text: behind a UTF-8 byte order mark if there is one.
std::size_t text_begin(std::string_view bytes);

/// @throws BadFile if the file begins with the byte order mark of UTF-16.
void refuse_utf16(const Source& source);

/// Reads the lines of a text file that hold data, as words separated by blanks. Numbers are read by std::from_chars,
/// which no locale changes. Lines end in LF, CR LF or CR, the last one also at the end of the file; a UTF-8 byte order
/// mark at the file's start is skipped.
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

  /// A word as a number, which may be infinite or not a number.
  double number(std::string_view word) const;
  double number(std::size_t i) const;
  /// Words first .. first + 2 as a point.
  Eigen::Vector3d point(std::size_t first) const { return {number(first), number(first + 1), number(first + 2)}; }
  /// A word as a signed integer.
  std::int64_t integer(std::string_view word) const;
  std::int64_t integer(std::size_t i) const { return integer(words_[i]); }

  std::size_t line() const { return line_; }
  std::string place() const;  ///< The current line, for messages: "line 7".
  /// Whether the current line has a line break behind it.
  bool ended() const { return ended_; }
  /// The lines so far that end in CR alone.
  const FileRepairs& lone_returns() const { return lone_returns_; }
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
  std::size_t line_feed_, return_;  // the first ones at or behind next_
  std::size_t line_;                // of the first line of words_
  std::size_t next_line_;           // of next_
  bool ended_ = true;
  FileRepairs lone_returns_;
  std::vector<std::string_view> words_;
};

/// The values of a text's elements (vertices, faces), separated by white space. Line breaks have no meaning in these
/// formats, but they show where a value is missing. The first line of each kind of element decides how lines are read:
/// - it holds one element or the beginning of one: every element begins on a new line and ends at the end of a line;
/// - it holds several elements: others may also begin in the middle of a line, and end on it;
/// - it holds several, of which the last continues on the next line: elements are divided anywhere. If they may have
/// any
///   number of values, every line but the last must have as many values as the first.
class TextValues {
 public:
  /// @param element names the current one, for messages: "face 3"
  TextValues(TextLines& lines, std::function<std::string()> element) : lines_(lines), element_(std::move(element)) {}

  /// Values left on the current line, or on the next one if there are none; 0 at the end of the file.
  std::size_t on_line() {
    if (next_ >= lines_.size() && lines_.next()) next_ = 0;
    return left_on_line();
  }
  std::size_t left_on_line() const { return lines_.size() - std::min(next_, lines_.size()); }
  /// The most values that the rest of the file can hold.
  std::size_t most_left() const { return left_on_line() + (lines_.remaining() + 1) / 2; }

  /// Elements of another kind follow. @param any_size they may have any number of values. @throws BadFile
  void begin_kind(bool any_size);
  /// Before an element's first word; false at the end of the file.
  bool begin_element() {
    from_middle_ = next_ > 0 && next_ < lines_.size();
    divided_ = false;
    if (next_ < lines_.size()) return true;
    if (anywhere_) leave_line();
    if (!lines_.next()) return false;
    next_ = 0;
    return true;
  }
  /// The next word of the element. @throws BadFile if there is none
  std::string_view word() {
    if (next_ >= lines_.size()) continue_on_next_line();
    return lines_.words()[next_++];
  }
  /// Behind an element's last word. @throws BadFile if it must end where the line does, but does not
  void end_element() {
    if (from_middle_ || divided_ || first_ || next_ < lines_.size()) check_layout();
  }

  /// Elements that do not stand on one line of their own.
  const FileRepairs& loose_elements() const { return loose_elements_; }
  /// @throws BadFile if there are more words
  void expect_end();

 private:
  void continue_on_next_line();
  void leave_line() const;
  void check_layout();
  [[noreturn]] void fail(const std::string& cause) const { lines_.fail(element_() + ": " + cause); }

  TextLines& lines_;
  std::function<std::string()> element_;
  FileRepairs loose_elements_;
  std::size_t next_ = std::string_view::npos;  // word of the line; the line at first is none of the values'
  bool first_ = true;                          // the element is the first of its kind
  bool several_ = false;                       // layout: more than one element on a line
  bool anywhere_ = false;                      // layout: divided anywhere
  bool any_size_ = false;                      // of the elements
  std::size_t on_first_line_ = 0;              // values of the kind's first line, where that matters
  std::size_t first_line_ = 0;                 // of the kind
  bool from_middle_ = false;                   // the element begins in the middle of a line
  bool divided_ = false;                       // it goes on on another
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
FileMesh read_gltf(const Source& source);
FileMesh read_obj(const Source& source);
FileMesh read_off(const Source& source);
FileMesh read_ply(const Source& source);
FileMesh read_stl(const Source& source);

/// Whether assimp has a reader for files with this extension.
bool assimp_reads(const std::string& extension);

/// Reads a file of any other format by assimp, as load.h says. All meshes of the scene become one surface. A damaged
/// file may crash it, or make it never return.
/// @param use is called while assimp still has the scene, which takes time to destroy
void read_by_assimp(const Source& source, FileFrame frame, const std::function<void(FileMesh&&)>& use);

/// The same surface, read in a process of its own. @throws BadFile also for what ends that process
FileMesh read_by_assimp_separately(const Source& source, FileFrame frame);

}  // namespace sixdof::loading
