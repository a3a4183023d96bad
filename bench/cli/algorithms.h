#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof algorithms [--json]`: what every algorithm of this build answers, its law, version and parameters.
void add_algorithms_command(CLI::App& app);

}  // namespace sixdof::cli
