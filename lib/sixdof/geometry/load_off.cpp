#include <fmt/format.h>

#include <sixdof/geometry/load_formats.h>
#include <sixdof/geometry/text_lines.h>

namespace sixdof::loading {
namespace {

/// Reads the line of the keyword; the counts may follow on the same line.
/// @param extras set if vertex lines hold more than a point.
void read_keyword(TextLines& lines, bool& extras) {
  if (!lines.next()) lines.fail("no data");
  const std::string_view keyword = lines.words()[0];
  if (keyword == "OFF") {
    extras = false;
  } else if (keyword == "COFF" || keyword == "NOFF" || keyword == "CNOFF" || keyword == "STOFF") {
    extras = true;
  } else if (keyword.starts_with("OFF")) {
    lines.fail("a blank or line break is missing behind the keyword OFF");
  } else {
    lines.fail("begins with none of OFF, COFF, NOFF, CNOFF, STOFF");
  }
  if (lines.size() > 1 && lines.words()[1] == "BINARY") lines.fail("binary OFF is not supported");
}

std::size_t read_count(const TextLines& lines, std::size_t word, const char* what, std::size_t least_bytes) {
  const std::int64_t count = lines.integer(word);
  if (count < 0 || static_cast<std::uint64_t>(count) > lines.remaining() / least_bytes) {
    lines.fail(fmt::format("{} {} do not fit into the {} bytes that follow", count, what, lines.remaining()));
  }
  return static_cast<std::size_t>(count);
}

}  // namespace

Surface read_off(const Source& source) {
  TextLines lines(source, {.comment = '#'});
  bool extras = false;
  read_keyword(lines, extras);
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
    if (static_cast<std::uint64_t>(count) > lines.size() - 1) {
      lines.fail(fmt::format("face {} has {} corners, but {} indices", i, count, lines.size() - 1));
    }
    corners.clear();
    for (std::size_t k = 1; k <= static_cast<std::size_t>(count); ++k) corners.push_back(lines.index(k, vertex_count));
    // A colour may follow: an index into a colour map, or 3 or 4 components.
    if (lines.size() > static_cast<std::size_t>(count) + 5) {
      lines.fail(fmt::format("face {} has {} corners, but {} values", i, count, lines.size() - 1));
    }
    for (std::size_t k = static_cast<std::size_t>(count) + 1; k < lines.size(); ++k) lines.number(k);
    const PolygonShape shape = triangulate(corners, surface.vertices, surface.triangles);
    if (shape != PolygonShape::simple) count_polygon(source, shape, lines.place(), surface.repairs);
  }
  lines.expect_end();
  return surface;
}

}  // namespace sixdof::loading
