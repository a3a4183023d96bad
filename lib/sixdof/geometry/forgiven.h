#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace sixdof {

/// Deviations from a file's format that are accepted and counted: those with one possible meaning, and polygons with
/// more than one possible surface.
enum class Forgiven : std::uint8_t {
  crossing_polygons,    ///< Polygons that cross themselves, triangulated (triangulate.h).
  nonplanar_polygons,   ///< Polygons that are not flat, triangulated.
  skipped_statements,   ///< OBJ statements that this project does not know, skipped.
  lone_returns,         ///< Lines that end in a carriage return alone.
  loose_elements,       ///< Vertices or faces that do not stand on one line of their own.
  faces_without_area,   ///< Faces of fewer than three corners, skipped.
  unused_bad_vertices,  ///< Vertices that are not finite and that no face uses, dropped.
  dropped_faces,        ///< Faces with a corner that is not finite, dropped; only where LoadOptions ask for it.
  late_vertices,        ///< OBJ faces that stand before their vertices.
  empty_numbers,        ///< Corners of OBJ faces with an empty number of texture or normal: "1//".
  undeclared_values,    ///< Vertices of a file of keyword OFF with colours or normals, which were skipped.
  off_keyword,          ///< The keyword OFF is missing, or no blank is behind it.
  stl_keywords,         ///< STL keywords in another form: "end loop", "outerloop".
  outside_solids,       ///< Lines outside of the solids of a text STL, skipped.
  trailing_blanks,      ///< Blank bytes behind the data of a binary file.
};
/// Number of kinds.
inline constexpr std::size_t k_forgiven_kinds = 15;

/// Deviations of one kind.
struct FileRepairs {
  std::size_t count = 0;    ///< How many were accepted.
  std::string first_place;  ///< Where in the file the first one is: "line 6", "face 2"; empty if there is none.
};

/// All accepted deviations of one file.
struct ForgivenKinds {
  /// By the number of the kind; of() finds them.
  std::array<FileRepairs, k_forgiven_kinds> kinds;

  /// Those of one kind.
  const FileRepairs& of(Forgiven kind) const { return kinds[static_cast<std::size_t>(kind)]; }
  /// Counts one more. @param place gives the place in the file; called for the first of a kind only
  template <class Place>
  void add(Forgiven kind, const Place& place) {
    FileRepairs& of_kind = kinds[static_cast<std::size_t>(kind)];
    if (of_kind.count++ == 0) of_kind.first_place = place();
  }
  /// Replaces those of one kind.
  void set(Forgiven kind, const FileRepairs& repairs) { kinds[static_cast<std::size_t>(kind)] = repairs; }
};

/// The kind as a key of JSON: "lone_returns".
const char* key_of(Forgiven kind);

/// One line: "8 lines that end in a carriage return alone (first: line 1); ..."; empty if nothing was forgiven.
std::string text_of(const ForgivenKinds& forgiven);

}  // namespace sixdof
