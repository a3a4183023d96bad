#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

constexpr std::size_t k_header_bytes = 80;
constexpr std::size_t k_count_bytes = 4;
constexpr std::size_t k_triangle_bytes = 50;  // normal, three corners: 12 floats; 2 bytes of attributes
constexpr std::size_t k_normal_bytes = 12;

using Corners = std::array<Eigen::Vector3d, 3>;

void add_triangle(const Source& source, const Corners& corners, const std::function<std::string()>& place,
                  FileMesh& surface) {
  for (const Eigen::Vector3d& p : corners) {
    if (!p.allFinite()) return drop_face(source, surface, place, place(), p);
  }
  const auto n = static_cast<std::uint32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), corners.begin(), corners.end());
  surface.triangles.push_back({n, n + 1, n + 2});
}

FileMesh read_binary(const Source& source, std::size_t count) {
  FileMesh surface;
  surface.vertices.reserve(3 * count);
  surface.triangles.reserve(count);
  const char* at = source.bytes.data() + k_header_bytes + k_count_bytes;
  for (std::size_t i = 0; i < count; ++i, at += k_triangle_bytes) {
    Corners corners;
    for (std::size_t k = 0; k < 9; ++k) {
      corners[k / 3][static_cast<Eigen::Index>(k % 3)] = load_bytes<float>(at + k_normal_bytes + 4 * k);
    }
    add_triangle(
        source, corners, [i] { return fmt::format("triangle {}", i); }, surface);
  }
  const auto end = static_cast<std::size_t>(at - source.bytes.data());
  if (end < source.bytes.size()) {
    surface.repairs.forgiven.set(Forgiven::trailing_blanks, {source.bytes.size() - end, fmt::format("byte {}", end)});
  }
  return surface;
}

bool is_word(std::string_view word, std::string_view lower_case) {
  return word.size() == lower_case.size() &&
         std::equal(word.begin(), word.end(), lower_case.begin(), [](char c, char l) { return (c | 0x20) == l; });
}

class TextReader {
 public:
  explicit TextReader(const Source& source) : source_(source), lines_(source, {}) {}

  FileMesh read() {
    bool any = false;
    while (lines_.next()) {
      if (!is_word(lines_.words()[0], "solid")) {
        skip_outside();
        continue;
      }
      any = true;
      for (advance(); !is_end("solid", true); advance()) read_facet();
    }
    if (!any) source_.fail("holds no solid");
    surface_.repairs.forgiven.set(Forgiven::lone_returns, lines_.lone_returns());
    return std::move(surface_);
  }

 private:
  /// Programs write comments behind the last solid. What belongs into a solid is an error outside of one, and so is a
  /// last line that may be the beginning of another solid.
  void skip_outside() {
    const std::string_view first = lines_.words()[0];
    for (const std::string_view word : {"facet", "outer", "outerloop", "vertex", "endloop", "endfacet"}) {
      if (is_word(first, word)) lines_.fail("'solid' is expected");
    }
    constexpr std::string_view k_solid = "solid";
    if (!lines_.ended() && lines_.size() == 1 && is_word(first, k_solid.substr(0, first.size()))) {
      lines_.fail("the file ends within the word 'solid'");
    }
    surface_.repairs.forgiven.add(Forgiven::outside_solids, [&] { return lines_.place(); });
  }

  void read_facet() {
    // Normals are often not numbers ("nan nan nan"); the order of the corners says which side is outside.
    if (!is_line({"facet", "normal"}, 3)) lines_.fail("'facet normal' with 3 numbers, or 'endsolid', is expected");
    advance();
    if (!is_line({"outer", "loop"}, 0)) {
      if (!is_line({"outerloop"}, 0)) lines_.fail("'outer loop' is expected");
      other_form();
    }
    Corners corners;
    std::size_t line = 0;  // of a corner that is not finite
    for (Eigen::Vector3d& corner : corners) {
      advance();
      if (!is_line({"vertex"}, 3)) lines_.fail("'vertex' with 3 numbers is expected");
      corner = lines_.point(1);
      if (!corner.allFinite()) line = lines_.line();
    }
    for (const char* word : {"loop", "facet"}) {
      advance();
      if (!is_end(word, false)) lines_.fail(fmt::format("'end{}' is expected", word));
    }
    add_triangle(
        source_, corners, [line] { return fmt::format("line {}", line); }, surface_);
  }

  void advance() {
    if (!lines_.next()) lines_.fail("the file ends within a solid");
  }

  /// Whether the line is these words and as many numbers.
  bool is_line(std::initializer_list<std::string_view> words, std::size_t numbers) const {
    return lines_.size() == words.size() + numbers &&
           std::equal(words.begin(), words.end(), lines_.words().begin(),
                      [](std::string_view expected, std::string_view word) { return is_word(word, expected); });
  }

  /// Whether the line is "endWORD" or "end WORD". @param named: a name may follow
  bool is_end(std::string_view word, bool named) {
    const auto& words = lines_.words();
    std::size_t used = 0;
    if (words[0].size() == 3 + word.size() && is_word(words[0].substr(0, 3), "end") &&
        is_word(words[0].substr(3), word)) {
      used = 1;
    } else if (words.size() > 1 && is_word(words[0], "end") && is_word(words[1], word)) {
      used = 2;
    }
    if (used == 0 || (!named && words.size() != used)) return false;
    if (used == 2) other_form();
    return true;
  }

  void other_form() {
    surface_.repairs.forgiven.add(Forgiven::stl_keywords, [&] { return lines_.place(); });
  }

  const Source& source_;
  TextLines lines_;
  FileMesh surface_;
};

}  // namespace

FileMesh read_stl(const Source& source) {
  const std::string& bytes = source.bytes;
  // Many binary files begin with "solid" too, so the size decides: count and size must agree, line breaks behind the
  // end aside. A text would need the right four bytes at the right place to be taken for binary, and its count would be
  // above 500 million.
  std::size_t count = 0;
  if (bytes.size() >= k_header_bytes + k_count_bytes) {
    count = load_bytes<std::uint32_t>(bytes.data() + k_header_bytes);
    const std::size_t end = k_header_bytes + k_count_bytes + k_triangle_bytes * count;
    if (bytes.size() >= end && is_blank_text(std::string_view(bytes).substr(end))) return read_binary(source, count);
  }
  refuse_utf16(source);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n", text_begin(bytes));
  const bool text = first != std::string::npos && is_word(std::string_view(bytes).substr(first, 5), "solid") &&
                    bytes.find('\0') == std::string::npos;
  if (text) return TextReader(source).read();
  if (bytes.size() < k_header_bytes + k_count_bytes) {
    source.fail(fmt::format("{} bytes are too few for a binary STL, and it does not begin with 'solid'", bytes.size()));
  }
  source.fail("byte 80", fmt::format("the count is {} triangles, which take {} bytes, but {} follow", count,
                                     k_triangle_bytes * count, bytes.size() - k_header_bytes - k_count_bytes));
}

}  // namespace sixdof::loading
