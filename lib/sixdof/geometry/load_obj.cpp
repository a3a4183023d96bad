#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

// Statements that hold no surface: points, lines, normals, texture coordinates, groups, materials, display attributes.
// Others, among them free-form curves and surfaces, are skipped as well, but counted.
constexpr std::array<std::string_view, 19> k_ignored{
    "vn",     "vt",     "p",     "l",   "g",        "o",        "s",          "mg",        "mtllib", "usemtl",
    "maplib", "usemap", "bevel", "lod", "c_interp", "d_interp", "shadow_obj", "trace_obj", "vp"};

/// The vertex of a corner written as v, v/vt, v//vn or v/vt/vn; numbers start at 1, negative ones count from the end.
std::uint32_t read_corner(const TextLines& lines, std::string_view word, std::size_t vertex_count) {
  const std::size_t slash = word.find('/');
  const std::int64_t number = lines.integer(word.substr(0, slash));
  const auto count = static_cast<std::int64_t>(vertex_count);
  if (number == 0 || number > count || number < -count) {
    lines.fail(fmt::format("vertex {} of the {} read so far (they count from 1)", number, count));
  }
  if (slash != std::string_view::npos) {
    const std::string_view rest = word.substr(slash + 1);
    const std::size_t second = rest.find('/');
    if (second != std::string_view::npos) lines.integer(rest.substr(second + 1));
    if (second != 0) lines.integer(rest.substr(0, second));
  }
  return static_cast<std::uint32_t>(number > 0 ? number - 1 : count + number);
}

}  // namespace

Surface read_obj(const Source& source) {
  TextLines lines(source, {.comment = '#', .continuation = true});
  Surface surface;
  std::vector<std::uint32_t> corners;
  while (lines.next()) {
    const std::string_view keyword = lines.words()[0];
    if (keyword == "v") {
      // x y z, then perhaps a weight, a colour, or both.
      if (lines.size() < 4 || lines.size() > 8) {
        lines.fail(fmt::format("a vertex of {} values, not 3", lines.size() - 1));
      }
      for (std::size_t i = 4; i < lines.size(); ++i) lines.number(i);
      surface.vertices.push_back(lines.point(1));
    } else if (keyword == "f") {
      if (lines.size() < 4) lines.fail(fmt::format("a face of {} corners", lines.size() - 1));
      corners.clear();
      for (std::size_t i = 1; i < lines.size(); ++i) {
        corners.push_back(read_corner(lines, lines.words()[i], surface.vertices.size()));
      }
      add_polygon(
          source, corners, [&] { return lines.place(); }, surface);
    } else if (std::find(k_ignored.begin(), k_ignored.end(), keyword) == k_ignored.end()) {
      count_repair(surface.repairs.skipped_statements, lines.place());
    }
  }
  const FileRepairs& skipped = surface.repairs.skipped_statements;
  if (surface.triangles.empty() && skipped.count > 0) {
    source.fail(skipped.first_place, fmt::format("no triangles: the file has no faces; {} statements that are no part "
                                                 "of a polygon mesh begin here",
                                                 skipped.count));
  }
  return surface;
}

}  // namespace sixdof::loading
