#pragma once

#include <string_view>

#include <sixdof/configuration/configuration_set.h>

/// Warnings about a pair or its set that do not stop a run: one line each on stderr, "PROGRAM: warning: ...".

namespace sixdof {

/// From this ratio of the boxes' diagonals on, two meshes probably have different units. Millimetres against metres
/// give 1000 for bodies of the same size.
constexpr double k_suspicious_size_ratio = 500.0;

/// One line if one mesh is k_suspicious_size_ratio times as large as the other or more.
void warn_of_sizes(std::string_view program, const MeshIdentity& a, const MeshIdentity& b);

/// One line for each note of the reader of a mesh's file (MeshRepairs::notes): what unit and axes the file states, and
/// what was done. @param argument that stands for the mesh on a command line
void say_notes(std::string_view program, const Mesh& mesh, std::string_view argument);

/// One line for every bucket of the set that no configuration reaches.
void warn_of_unreached(std::string_view program, const ConfigurationSet& set);

}  // namespace sixdof
