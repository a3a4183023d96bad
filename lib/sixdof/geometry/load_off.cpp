#include <fmt/format.h>

#include <sixdof/base/visible_text.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

/// Reads the line of the keyword; the counts may follow on the same line.
/// @return whether vertex lines may hold more than a point
bool read_keyword(TextLines& lines) {
  if (!lines.next()) lines.fail("no data");
  const std::string_view keyword = lines.words()[0];
  const bool extras = keyword == "COFF" || keyword == "NOFF" || keyword == "CNOFF" || keyword == "STOFF";
  if (!extras && keyword != "OFF") {
    lines.fail(keyword.starts_with("OFF")
                   ? "a blank or line break is missing behind the keyword OFF"
                   : fmt::format("begins with '{}', not OFF, COFF, NOFF, CNOFF or STOFF", visible_text(keyword)));
  }
  if (lines.size() > 1 && lines.words()[1] == "BINARY") lines.fail("binary OFF is not supported");
  return extras;
}

std::size_t read_count(const TextLines& lines, std::size_t word, const char* what, std::size_t least_bytes) {
  const std::int64_t count = lines.integer(word);
  // The last line may lack its line break.
  if (count < 0 || static_cast<std::uint64_t>(count) > (lines.remaining() + 1) / least_bytes) {
    lines.fail(fmt::format("{} {} do not fit into the {} bytes that follow", count, what, lines.remaining()));
  }
  return static_cast<std::size_t>(count);
}

}  // namespace

Surface read_off(const Source& source) {
  TextLines lines(source, {.comment = '#'});
  const bool extras = read_keyword(lines);
  std::size_t first = 1;
  if (lines.size() == 1) {
    if (!lines.next()) lines.fail("the counts are missing");
    first = 0;
  }
  // The number of edges is often 0 or missing, and not used.
  if (lines.size() != first + 3 && lines.size() != first + 2) {
    lines.fail("the counts of vertices, faces and edges are expected");
  }
  constexpr std::size_t k_least_vertex = sizeof("0 0 0\n") - 1;
  constexpr std::size_t k_least_face = sizeof("3 0 1 2\n") - 1;
  const std::size_t vertex_count = read_count(lines, first, "vertices", k_least_vertex);
  const std::size_t face_count = read_count(lines, first + 1, "faces", k_least_face);
  if (lines.size() == first + 3) lines.integer(first + 2);

  Surface surface;
  surface.vertices.reserve(vertex_count);
  for (std::size_t i = 0; i < vertex_count; ++i) {
    if (!lines.next()) lines.fail(fmt::format("the file ends after {} of {} vertices", i, vertex_count));
    if (lines.size() < 3 || (lines.size() > 3 && !extras)) {
      lines.fail(fmt::format("vertex {} has {} values, not 3", i, lines.size()));
    }
    surface.vertices.push_back(lines.point(0));
  }
  surface.triangles.reserve(face_count);
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < face_count; ++i) {
    if (!lines.next()) lines.fail(fmt::format("the file ends after {} of {} faces", i, face_count));
    const std::int64_t count = lines.integer(std::size_t{0});
    if (count < 3) lines.fail(fmt::format("face {} has {} corners", i, count));
    const auto last = static_cast<std::size_t>(count);
    const std::size_t values = lines.size() - 1;
    if (last > values) lines.fail(fmt::format("face {} has {} corners, but {} indices", i, count, values));
    corners.clear();
    for (std::size_t k = 1; k <= last; ++k) {
      const std::int64_t v = lines.integer(k);
      if (v < 0 || static_cast<std::uint64_t>(v) >= vertex_count) {
        lines.fail(fmt::format("vertex index {} of {}", v, vertex_count));
      }
      corners.push_back(static_cast<std::uint32_t>(v));
    }
    // A colour may follow: an index into a colour map, or 3 or 4 components.
    if (values > last + 4) lines.fail(fmt::format("face {} has {} corners, but {} values", i, count, values));
    for (std::size_t k = last + 1; k <= values; ++k) lines.number(k);
    add_polygon(
        source, corners, [&] { return lines.place(); }, surface);
  }
  lines.expect_end();
  return surface;
}

}  // namespace sixdof::loading
