#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof algorithms [--json]`: what every algorithm of this build answers, its law, version and parameters, and
/// whether benchmarks time it.
void add_algorithms_command(CLI::App& app);

}  // namespace sixdof::cli
