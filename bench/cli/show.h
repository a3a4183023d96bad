#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof show --algorithm NAME --model M -o FILE.ply`: what `ist`, `vps` or `vps-field` prepares of a mesh, as a
/// coloured PLY (structure_drawing.h defines the colours).
void add_show_command(CLI::App& app);

}  // namespace sixdof::cli
