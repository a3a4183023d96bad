#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof show --algorithm NAME --model M -o FILE.ply`: what `ist`, `vps` or `vps-field` builds of a mesh, as a
/// coloured PLY to look at (structure_drawing.h says what the colours mean).
void add_show_command(CLI::App& app);

}  // namespace sixdof::cli
