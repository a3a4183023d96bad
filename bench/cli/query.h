#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof query --a MESH --b MESH --pose POSE [--algorithm NAME] [--json]`: the answers of one algorithm at one pose.
void add_query_command(CLI::App& app);

}  // namespace sixdof::cli
