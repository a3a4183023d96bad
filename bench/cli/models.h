#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof models list [--json]`: every model with its triangle counts and size, and whether a fetched one is here.
/// `sixdof models make NAME [--triangles N] -o FILE`: writes a model to a mesh file, which appears whole or not at all.
void add_models_command(CLI::App& app);

}  // namespace sixdof::cli
