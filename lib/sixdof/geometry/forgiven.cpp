#include <sixdof/geometry/forgiven.h>

#include <fmt/format.h>

namespace sixdof {
namespace {

struct Words {
  const char* key;
  const char* one;
  const char* many;
};

constexpr std::array<Words, k_forgiven_kinds> k_words{{
    {"crossing_polygons", "polygon that crosses itself, triangulated", "polygons that cross themselves, triangulated"},
    {"nonplanar_polygons", "polygon that is not flat, triangulated", "polygons that are not flat, triangulated"},
    {"skipped_statements", "unknown statement, skipped", "unknown statements, skipped"},
    {"lone_returns", "line that ends in a carriage return alone", "lines that end in a carriage return alone"},
    {"loose_elements", "element not on one line of its own", "elements not on one line of their own"},
    {"faces_without_area", "face of fewer than 3 corners, skipped", "faces of fewer than 3 corners, skipped"},
    {"unused_bad_vertices", "unused vertex that is not finite, dropped",
     "unused vertices that are not finite, dropped"},
    {"dropped_faces", "face with a corner that is not finite, dropped",
     "faces with a corner that is not finite, dropped"},
    {"late_vertices", "face before its vertices", "faces before their vertices"},
    {"empty_numbers", "corner with an empty number of texture or normal",
     "corners with an empty number of texture or normal"},
    {"undeclared_values", "vertex with colours or normals that the keyword OFF does not announce, skipped",
     "vertices with colours or normals that the keyword OFF does not announce, skipped"},
    {"off_keyword", "keyword OFF missing or without a blank behind it",
     "keywords OFF missing or without a blank behind them"},
    {"stl_keywords", "keyword in another form", "keywords in another form"},
    {"outside_solids", "line outside of a solid, skipped", "lines outside of solids, skipped"},
    {"trailing_blanks", "blank byte behind the data", "blank bytes behind the data"},
}};

}  // namespace

const char* key_of(Forgiven kind) { return k_words[static_cast<std::size_t>(kind)].key; }

std::string text_of(const ForgivenKinds& forgiven) {
  std::string text;
  for (std::size_t k = 0; k < k_forgiven_kinds; ++k) {
    const FileRepairs& of_kind = forgiven.kinds[k];
    if (of_kind.count == 0) continue;
    text += fmt::format("{}{} {} ({}{})", text.empty() ? "" : "; ", of_kind.count,
                        of_kind.count == 1 ? k_words[k].one : k_words[k].many,
                        of_kind.count == 1 ? "" : "first: ", of_kind.first_place);
  }
  return text;
}

}  // namespace sixdof
