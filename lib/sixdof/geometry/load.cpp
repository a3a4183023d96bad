#include <sixdof/geometry/load.h>

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
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

void count_repair(FileRepairs& repairs, const std::string& place) {
  if (repairs.count++ == 0) repairs.first_place = place;
}

void add_polygon(const Source& source, std::span<const std::uint32_t> corners,
                 const std::function<std::string()>& place, Surface& surface) {
  switch (triangulate(corners, surface.vertices, surface.triangles)) {
    case PolygonShape::simple:
      return;
    case PolygonShape::not_flat:
      return count_repair(surface.repairs.nonplanar_polygons, place());
    case PolygonShape::crossing:
      return count_repair(surface.repairs.crossing_polygons, place());
    case PolygonShape::too_large:
      source.fail(place(),
                  fmt::format("a concave polygon of more than {} corners", k_most_corners_of_a_concave_polygon));
  }
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
  const std::size_t newline = text_.find('\n', next_);
  const bool ended = newline != std::string_view::npos;
  std::string_view line = text_.substr(next_, (ended ? newline : text_.size()) - next_);
  next_ = ended ? newline + 1 : text_.size();
  ++next_line_;
  if (syntax_.comment != '\0') line = line.substr(0, line.find(syntax_.comment));
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  const bool continues = syntax_.continuation && ended && !line.empty() && line.back() == '\\';
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
  if (!std::isfinite(static_cast<double>(value))) fail(fmt::format("'{}' is not finite", visible_text(word)));
  return value;
}

double TextLines::number(std::size_t i) const {
  if (i >= words_.size()) fail(fmt::format("{} values where at least {} are needed", words_.size(), i + 1));
  return parse<double>(words_[i], "outside the range of double precision", "a number");
}

std::int64_t TextLines::integer(std::string_view word) const {
  return parse<std::int64_t>(word, "out of range", "an integer");
}

std::string TextLines::place() const { return fmt::format("line {}", line_); }

void TextLines::fail(const std::string& cause) const { source_.fail(place(), cause); }

void TextLines::expect_end() {
  if (next()) fail(fmt::format("'{}' behind the last element", visible_text(words_[0])));
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

Surface read_surface(const Named& named) {
  const auto& [file, frame] = named;
  const std::string extension = lower_case_extension(file);
  if (frame == FileFrame::y_up && extension != ".dae" && extension != ".zae") {
    throw BadFile(file.string(), "#y-up is for COLLADA, the only format whose axes are known and may be others");
  }
  if (extension == ".ply") return read_ply(read_source(file));
  if (extension == ".off") return read_off(read_source(file));
  if (extension == ".obj") return read_obj(read_source(file));
  if (extension == ".stl") return read_stl(read_source(file));
  if (extension == ".gltf" || extension == ".glb") return read_gltf(read_source(file));
  if (extension.empty()) {
    throw BadFile(file.string(),
                  "has no extension, which would say its mesh format (.ply, .obj, .stl, .off, .glb and others)");
  }
  if (!assimp_reads(extension)) throw BadFile(file.string(), "'" + visible_text(extension) + "' is no mesh format");
  return read_by_assimp_separately(read_source(file), frame);
}

}  // namespace
}  // namespace loading

std::filesystem::path mesh_file_of(const std::filesystem::path& name) { return loading::parse_name(name).file; }

Mesh load_mesh(const std::filesystem::path& name) {
  const loading::Named named = loading::parse_name(name);
  const std::filesystem::path& file = named.file;
  try {
    loading::Surface surface = loading::read_surface(named);
    return Mesh::build(std::move(surface.vertices), std::move(surface.triangles), file.stem().string(),
                       std::move(surface.repairs));
  } catch (const BadMesh& e) {
    throw BadFile(file.string(), e.what());
  } catch (const std::bad_alloc&) {
    throw BadFile(file.string(), "does not fit into memory");
  }
}

}  // namespace sixdof
