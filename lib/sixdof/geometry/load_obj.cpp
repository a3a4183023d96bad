#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {
namespace {

// Statements that hold no surface: points, lines, normals, texture coordinates, groups, materials, display attributes.
// Others, among them free-form curves and surfaces, are skipped as well, but counted.
constexpr std::array<std::string_view, 19> k_ignored{
    "vn",     "vt",     "p",     "l",   "g",        "o",        "s",          "mg",        "mtllib", "usemtl",
    "maplib", "usemap", "bevel", "lod", "c_interp", "d_interp", "shadow_obj", "trace_obj", "vp"};

class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), lines_(source, {.comment = '#', .continuation = true}) {}

  FileMesh read() {
    while (lines_.next()) {
      const std::string_view keyword = lines_.words()[0];
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "f" || keyword == "fo") {  // "fo": the format's first versions
        read_face();
      } else if (std::find(k_ignored.begin(), k_ignored.end(), keyword) == k_ignored.end()) {
        surface_.repairs.forgiven.add(Forgiven::skipped_statements, [&] { return lines_.place(); });
      }
    }
    add_late_polygons();
    const FileRepairs& skipped = surface_.repairs.forgiven.of(Forgiven::skipped_statements);
    if (surface_.triangles.empty() && skipped.count > 0) {
      source_.fail(skipped.first_place, fmt::format("no triangles: the file has no faces; {} statements that are no "
                                                    "part of a polygon mesh begin here",
                                                    skipped.count));
    }
    surface_.repairs.forgiven.set(Forgiven::lone_returns, lines_.lone_returns());
    return std::move(surface_);
  }

 private:
  /// x y z, then perhaps a weight, a colour, or both. The weight is that of rational curves and surfaces. Some programs
  /// divide by it, others do not look at it, and a few write a value of another meaning there: a polygon may use a
  /// vertex only if it is 1.
  void read_vertex() {
    const std::size_t values = lines_.size() - 1;
    if (values < 3 || values > 7) lines_.fail(fmt::format("a vertex of {} values, not 3", values));
    for (std::size_t i = 4; i <= values; ++i) lines_.number(i);
    const double weight = values == 4 ? lines_.number(4) : 1.0;
    if (weight != 1.0) {
      surface_.unusable.push_back({static_cast<std::uint32_t>(surface_.vertices.size()), lines_.line(), weight});
      surface_.vertices.push_back(lines_.point(1));
    } else {
      surface_.add_vertex(lines_.point(1), lines_.line());
    }
  }

  void read_face() {
    // A face of two corners is an edge, as some programs write it; but it may also be what is left of a face where the
    // file was cut off.
    if (lines_.size() < 3 || (lines_.size() == 3 && !lines_.ended())) {
      lines_.fail(fmt::format("a face of {} corners", lines_.size() - 1));
    }
    corners_.clear();
    bool late = false;
    for (std::size_t i = 1; i < lines_.size(); ++i) {
      corners_.push_back(read_corner(lines_.words()[i]));
      late = late || corners_.back() >= surface_.vertices.size();
    }
    if (late) surface_.repairs.forgiven.add(Forgiven::late_vertices, [&] { return lines_.place(); });
    if (late || !late_.empty()) {
      late_.add(corners_, lines_.line(), 0);
    } else {
      add_polygon(
          source_, corners_, [&] { return lines_.place(); }, surface_);
    }
  }

  /// The vertex of a corner written as v, v/vt, v//vn or v/vt/vn; numbers start at 1, negative ones count from the end.
  std::uint32_t read_corner(std::string_view word) {
    const std::size_t slash = word.find('/');
    const std::int64_t number = lines_.integer(word.substr(0, slash));
    const auto count = static_cast<std::int64_t>(surface_.vertices.size());
    if (number == 0 || number < -count || number > std::numeric_limits<std::uint32_t>::max()) {
      lines_.fail(fmt::format("vertex {} of the {} read so far (they count from 1)", number, count));
    }
    if (slash != std::string_view::npos) {
      const std::string_view rest = word.substr(slash + 1);
      const std::size_t second = rest.find('/');
      bool empty = second == std::string_view::npos && rest.empty();
      if (second != std::string_view::npos) {
        const std::string_view normal = rest.substr(second + 1);
        normal.empty() ? void(empty = true) : void(lines_.integer(normal));
      }
      if (second != 0 && !rest.empty()) lines_.integer(rest.substr(0, second));
      if (empty) surface_.repairs.forgiven.add(Forgiven::empty_numbers, [&] { return lines_.place(); });
    }
    return static_cast<std::uint32_t>(number > 0 ? number - 1 : count + number);
  }

  void add_late_polygons() {
    late_.for_each([&](std::span<const std::uint32_t> corners, std::size_t line, std::uint64_t) {
      const auto place = [&] { return fmt::format("line {}", line); };
      for (const std::uint32_t v : corners) {
        if (v < surface_.vertices.size()) continue;
        source_.fail(place(), fmt::format("vertex {} of the {} in the file (they count from 1)", std::uint64_t{v} + 1,
                                          surface_.vertices.size()));
      }
      add_polygon(source_, corners, place, surface_);
    });
  }

  const Source& source_;
  TextLines lines_;
  FileMesh surface_;
  std::vector<std::uint32_t> corners_;
  LatePolygons late_;
};

}  // namespace

FileMesh read_obj(const Source& source) { return Reader(source).read(); }

}  // namespace sixdof::loading
