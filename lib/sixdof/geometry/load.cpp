#include <sixdof/geometry/load.h>

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <new>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/geometry/load_formats.h>
#include <sixdof/geometry/triangulate.h>

namespace sixdof {
namespace loading {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

std::string lower_case_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

void Source::fail(const std::string& cause) const { throw BadFile(path.string(), cause); }

void Source::fail(const std::string& place, const std::string& cause) const {
  throw BadFile(path.string(), place, cause);
}

Source read_source(const std::filesystem::path& file) {
  Source source{file, {}};
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) source.fail("cannot be read: " + std::string(std::strerror(errno)));
  // Reading a pipe or a device might never end.
  if (!S_ISREG(status.st_mode)) source.fail("cannot be read: not a regular file");
  std::ifstream in(file, std::ios::binary);
  if (!in) source.fail("cannot be read: " + std::string(std::strerror(errno)));
  source.bytes.resize(static_cast<std::size_t>(status.st_size));
  in.read(source.bytes.data(), static_cast<std::streamsize>(source.bytes.size()));
  if (static_cast<std::size_t>(in.gcount()) != source.bytes.size()) source.fail("cannot be read to its end");
  if (source.bytes.empty()) source.fail("is empty");
  return source;
}

void drop_face(const Source& source, FileMesh& surface, const std::function<std::string()>& face,
               const std::string& corner, const Eigen::Vector3d& p) {
  if (!source.options.drop_faces_not_finite) {
    source.fail(corner, fmt::format("coordinates ({}, {}, {}) of a face's corner are not finite; sixdof repair drops "
                                    "such faces",
                                    p.x(), p.y(), p.z()));
  }
  surface.repairs.forgiven.add(Forgiven::dropped_faces, face);
}

namespace {

/// @return whether the polygon is dropped, since it has a corner that is not finite
bool has_unusable_corner(const Source& source, std::span<const std::uint32_t> corners,
                         const std::function<std::string()>& place, FileMesh& surface) {
  for (const std::uint32_t v : corners) {
    const auto found = std::lower_bound(surface.unusable.begin(), surface.unusable.end(), v,
                                        [](const UnusableVertex& u, std::uint32_t w) { return u.vertex < w; });
    if (found == surface.unusable.end() || found->vertex != v) continue;
    const std::string corner = found->line > 0 ? fmt::format("line {}", found->line) : fmt::format("vertex {}", v);
    if (found->weight != 1.0) {
      source.fail(corner,
                  fmt::format("a vertex of weight {}, which faces use ({}): a polygon's vertices have no weight "
                              "other than 1, and what is meant is not clear",
                              found->weight, place()));
    }
    drop_face(source, surface, place, corner, surface.vertices[v]);
    return true;
  }
  return false;
}

}  // namespace

void add_polygon(const Source& source, std::span<const std::uint32_t> corners,
                 const std::function<std::string()>& place, FileMesh& surface) {
  if (corners.size() < 3) return surface.repairs.forgiven.add(Forgiven::faces_without_area, place);
  if (!surface.unusable.empty() && has_unusable_corner(source, corners, place, surface)) return;
  switch (triangulate(corners, surface.vertices, surface.triangles)) {
    case PolygonShape::simple:
      return;
    case PolygonShape::not_flat:
      return surface.repairs.forgiven.add(Forgiven::nonplanar_polygons, place);
    case PolygonShape::crossing:
      return surface.repairs.forgiven.add(Forgiven::crossing_polygons, place);
    case PolygonShape::too_large:
      source.fail(place(),
                  fmt::format("a concave polygon of more than {} corners", k_most_corners_of_a_concave_polygon));
  }
}

std::string decode_percent(const std::string& text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    int length = 0;
    if (std::sscanf(text.c_str() + i, "%%%2x%n", &code, &length) == 1 && length == 3) {
      name += static_cast<char>(code);
      i += 2;
    } else {
      name += text[i];
    }
  }
  return name;
}

bool is_blank_text(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c == '\n' || is_blank(c); });
}

std::size_t text_begin(std::string_view bytes) {
  constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";
  return bytes.starts_with(k_byte_order_mark) ? k_byte_order_mark.size() : 0;
}

void refuse_utf16(const Source& source) {
  const std::string_view bytes = source.bytes;
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    source.fail("line 1", "begins with " + visible_text(bytes.substr(0, 2)) + ": UTF-16; save it as ASCII or UTF-8");
  }
}

TextLines::TextLines(const Source& source, Syntax syntax, std::size_t begin, std::size_t line)
    : source_(source),
      text_(source.bytes),
      syntax_(syntax),
      next_(std::max(begin, text_begin(source.bytes))),
      line_feed_(text_.find('\n', next_)),
      return_(text_.find('\r', next_)),
      line_(line),
      next_line_(line) {
  refuse_utf16(source);
}

bool TextLines::next() {
  words_.clear();
  while (next_ < text_.size()) {
    line_ = next_line_;
    while (read_line()) {
    }
    if (!words_.empty()) return true;
  }
  line_ = next_line_;
  return false;
}

/// Adds one line's words; true if the next line continues it.
bool TextLines::read_line() {
  // Found once: looking for what a text does not have, line by line, would take quadratic time.
  if (line_feed_ < next_) line_feed_ = text_.find('\n', next_);
  if (return_ < next_) return_ = text_.find('\r', next_);
  const std::size_t end = std::min({line_feed_, return_, text_.size()});
  const bool crlf = end == return_ && end + 1 == line_feed_;
  if (end == return_ && !crlf && lone_returns_.count++ == 0)
    lone_returns_.first_place = fmt::format("line {}", next_line_);
  ended_ = end < text_.size();
  std::string_view line = text_.substr(next_, end - next_);
  next_ = ended_ ? end + (crlf ? 2 : 1) : text_.size();
  ++next_line_;
  if (syntax_.comment != '\0') line = line.substr(0, line.find(syntax_.comment));
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  const bool continues = syntax_.continuation && ended_ && !line.empty() && line.back() == '\\';
  if (continues) line.remove_suffix(1);
  for (std::size_t i = 0; i < line.size();) {
    if (is_blank(line[i])) {
      ++i;
      continue;
    }
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    words_.push_back(line.substr(begin, i - begin));
  }
  return continues;
}

template <class T>
T TextLines::parse(std::string_view word, const char* range, const char* kind) const {
  // Text files may write a leading plus sign, which from_chars does not read.
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range) fail(fmt::format("'{}' is {}", visible_text(word), range));
  if (error != std::errc() || end != word.data() + word.size()) {
    fail(fmt::format("'{}' is not {}", visible_text(word), kind));
  }
  return value;
}

double TextLines::number(std::string_view word) const {
  // "1.#IND", "-1.#QNAN", "1.#INF00": as some programs write what is not finite.
  if (word.find(".#") != std::string_view::npos) return std::numeric_limits<double>::quiet_NaN();
  return parse<double>(word, "outside the range of double precision", "a number");
}

double TextLines::number(std::size_t i) const {
  if (i >= words_.size()) fail(fmt::format("{} values where at least {} are needed", words_.size(), i + 1));
  return number(words_[i]);
}

std::int64_t TextLines::integer(std::string_view word) const {
  return parse<std::int64_t>(word, "out of range", "an integer");
}

std::string TextLines::place() const { return fmt::format("line {}", line_); }

void TextLines::fail(const std::string& cause) const { source_.fail(place(), cause); }

void TextLines::expect_end() {
  if (next()) fail(fmt::format("'{}' behind the last element", visible_text(words_[0])));
}

void TextValues::begin_kind(bool any_size) {
  const bool from_middle = next_ > 0 && next_ < lines_.size();
  if (anywhere_ && from_middle) fail("ends in the middle of a line, where another kind of element begins");
  first_ = true;
  several_ = from_middle;
  anywhere_ = false;
  any_size_ = any_size;
}

void TextValues::leave_line() const {
  if (!any_size_ || lines_.size() == on_first_line_) return;
  fail(fmt::format("the line has {} values, the first one {}: where an element ends is not clear", lines_.size(),
                   on_first_line_));
}

void TextValues::continue_on_next_line() {
  if (from_middle_ && !divided_ && !anywhere_) {
    if (!first_ && lines_.line() != first_line_)
      fail("a value is missing on the line, or there is one too many before it");
    anywhere_ = true;
    on_first_line_ = lines_.size();
  }
  if (anywhere_) leave_line();
  divided_ = true;
  if (!lines_.next()) fail("the file ends within it");
  next_ = 0;
}

void TextValues::check_layout() {
  if ((from_middle_ || divided_) && loose_elements_.count++ == 0) {
    loose_elements_.first_place = lines_.place() + ": " + element_();
  }
  const bool left = next_ < lines_.size();
  if (first_) {
    first_line_ = lines_.line();
    several_ = several_ || (left && !divided_);
    first_ = false;
  }
  if (left && !several_) fail(fmt::format("{} values where {} are expected", lines_.size(), next_));
}

void TextValues::expect_end() {
  if (on_line() > 0) lines_.fail(fmt::format("'{}' behind the last element", visible_text(lines_.words()[next_])));
}

namespace {

/// A file, and what is done with its unit and axes.
struct Named {
  std::filesystem::path file;
  FileFrame frame = FileFrame::metres;
};

constexpr std::array k_frames{std::pair("#as-stored", FileFrame::as_stored), std::pair("#y-up", FileFrame::y_up)};

/// The parts of "part.dae#as-stored". Any file may have such a name itself.
Named parse_name(const std::filesystem::path& name) {
  const std::string text = name.string();
  std::error_code ignored;
  for (const auto& [words, frame] : k_frames) {
    if (!text.ends_with(words) || std::filesystem::exists(name, ignored)) continue;
    return {text.substr(0, text.size() - std::string_view(words).size()), frame};
  }
  return {name};
}

FileMesh read_surface(const Named& named, const LoadOptions& options) {
  const auto& [file, frame] = named;
  const std::string extension = lower_case_extension(file);
  if (frame == FileFrame::y_up && extension != ".dae" && extension != ".zae") {
    throw BadFile(file.string(), "#y-up is for COLLADA, the only format whose axes are known and may be others");
  }
  const auto source = [&path = file, &options] {
    Source bytes = read_source(path);
    bytes.options = options;
    return bytes;
  };
  if (extension == ".ply") return read_ply(source());
  if (extension == ".off") return read_off(source());
  if (extension == ".obj") return read_obj(source());
  if (extension == ".stl") return read_stl(source());
  if (extension == ".gltf" || extension == ".glb") return read_gltf(source());
  if (extension.empty()) {
    throw BadFile(file.string(),
                  "has no extension, which would say its mesh format (.ply, .obj, .stl, .off, .glb and others)");
  }
  if (!assimp_reads(extension)) throw BadFile(file.string(), "'" + visible_text(extension) + "' is no mesh format");
  return read_by_assimp_separately(source(), frame);
}

/// No triangle uses a vertex that is not finite, so Mesh::build drops it, wherever it is.
void move_bad_vertices(FileMesh& surface) {
  for (const UnusableVertex& bad : surface.unusable) {
    if (bad.weight != 1.0) continue;
    surface.vertices[bad.vertex].setZero();
    surface.repairs.forgiven.add(Forgiven::unused_bad_vertices, [&] {
      return bad.line > 0 ? fmt::format("line {}", bad.line) : fmt::format("vertex {}", bad.vertex);
    });
  }
}

}  // namespace
}  // namespace loading

std::filesystem::path mesh_file_of(const std::filesystem::path& name) { return loading::parse_name(name).file; }

Mesh load_mesh(const std::filesystem::path& name, const LoadOptions& options) {
  const loading::Named named = loading::parse_name(name);
  const std::filesystem::path& file = named.file;
  try {
    loading::FileMesh surface = loading::read_surface(named, options);
    loading::move_bad_vertices(surface);
    return Mesh::build(std::move(surface.vertices), std::move(surface.triangles), file.stem().string(),
                       std::move(surface.repairs));
  } catch (const BadMesh& e) {
    throw BadFile(file.string(), e.what());
  } catch (const std::bad_alloc&) {
    throw BadFile(file.string(), "does not fit into memory");
  }
}

}  // namespace sixdof
