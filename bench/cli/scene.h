#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof scene make FAMILY [-n N] -o FILE`: a scene of many bodies, of a family or of meshes and a table of poses.
/// `sixdof scene info FILE [--json]`: what it holds. `sixdof scene play FILE [--algorithms LIST] [--question LIST]
/// [--bodies LIST] [--frames FIRST:LAST]`: its recorded motion, or a part of it, replayed to every algorithm, with
/// time, work and misses; k_exit_defects if an answer of one of this project's own has not the bits of the truth
/// (lib/sixdof/scene/README.md). With `--list` the pairs, distances and wrenches themselves.
void add_scene_command(CLI::App& app);

/// Adds `play` to `scene`.
void add_scene_play(CLI::App& group);

}  // namespace sixdof::cli
