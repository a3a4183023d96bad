#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

constexpr std::size_t k_header_bytes = 80;
constexpr std::size_t k_count_bytes = 4;
constexpr std::size_t k_triangle_bytes = 50;  // normal, three corners: 12 floats; 2 bytes of attributes
constexpr std::size_t k_normal_bytes = 12;

void add_triangle(Surface& surface, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const auto n = static_cast<std::uint32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), {a, b, c});
  surface.triangles.push_back({n, n + 1, n + 2});
}

Surface read_binary(const Source& source, std::size_t count) {
  Surface surface;
  surface.vertices.reserve(3 * count);
  surface.triangles.reserve(count);
  const char* at = source.bytes.data() + k_header_bytes + k_count_bytes;
  for (std::size_t i = 0; i < count; ++i, at += k_triangle_bytes) {
    Eigen::Vector3d corners[3];
    for (std::size_t k = 0; k < 9; ++k) {
      const double value = load_bytes<float>(at + k_normal_bytes + 4 * k);
      if (!std::isfinite(value)) source.fail(fmt::format("triangle {}", i), "a coordinate is not finite");
      corners[k / 3][static_cast<Eigen::Index>(k % 3)] = value;
    }
    add_triangle(surface, corners[0], corners[1], corners[2]);
  }
  return surface;
}

bool is_word(std::string_view word, std::string_view lower_case) {
  return word.size() == lower_case.size() &&
         std::equal(word.begin(), word.end(), lower_case.begin(), [](char c, char l) { return (c | 0x20) == l; });
}

/// Whether the line is these words and as many numbers.
bool is_line(const TextLines& lines, std::initializer_list<std::string_view> words, std::size_t numbers) {
  return lines.size() == words.size() + numbers &&
         std::equal(words.begin(), words.end(), lines.words().begin(),
                    [](std::string_view expected, std::string_view word) { return is_word(word, expected); });
}

Surface read_text(const Source& source) {
  Surface surface;
  TextLines lines(source, {});
  const auto advance = [&] {
    if (!lines.next()) lines.fail("the file ends within a solid");
  };
  const auto expect = [&](std::initializer_list<std::string_view> words, std::size_t numbers) {
    advance();
    if (is_line(lines, words, numbers)) return;
    lines.fail(fmt::format("'{}' with {} numbers is expected", fmt::join(words, " "), numbers));
  };
  bool any = false;
  while (lines.next()) {
    if (!is_word(lines.words()[0], "solid")) lines.fail("'solid' is expected");
    any = true;
    for (advance(); !is_word(lines.words()[0], "endsolid"); advance()) {
      // Normals are often not numbers ("nan nan nan"); the order of the corners says which side is outside.
      if (!is_line(lines, {"facet", "normal"}, 3)) {
        lines.fail("'facet normal' with 3 numbers, or 'endsolid', is expected");
      }
      expect({"outer", "loop"}, 0);
      Eigen::Vector3d corners[3];
      for (Eigen::Vector3d& corner : corners) {
        expect({"vertex"}, 3);
        corner = lines.point(1);
      }
      expect({"endloop"}, 0);
      expect({"endfacet"}, 0);
      add_triangle(surface, corners[0], corners[1], corners[2]);
    }
  }
  if (!any) source.fail("holds no solid");
  return surface;
}

}  // namespace

Surface read_stl(const Source& source) {
  const std::string& bytes = source.bytes;
  // Many binary files begin with "solid" too, so the size decides: count and size must agree. A text would need the
  // right four bytes at the right place to be taken for binary, and its count would be above 500 million.
  std::size_t count = 0;
  if (bytes.size() >= k_header_bytes + k_count_bytes) {
    count = load_bytes<std::uint32_t>(bytes.data() + k_header_bytes);
    if (bytes.size() == k_header_bytes + k_count_bytes + k_triangle_bytes * count) return read_binary(source, count);
  }
  refuse_utf16(source);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n", text_begin(bytes));
  const bool text = first != std::string::npos && is_word(std::string_view(bytes).substr(first, 5), "solid") &&
                    bytes.find('\0') == std::string::npos;
  if (text) return read_text(source);
  if (bytes.size() < k_header_bytes + k_count_bytes) {
    source.fail(fmt::format("{} bytes are too few for a binary STL, and it does not begin with 'solid'", bytes.size()));
  }
  source.fail("byte 80", fmt::format("the count is {} triangles, which take {} bytes, but {} follow", count,
                                     k_triangle_bytes * count, bytes.size() - k_header_bytes - k_count_bytes));
}

}  // namespace sixdof::loading
