#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof query`: one pose, every answer that one algorithm gives.
void add_query_command(CLI::App& app);

}  // namespace sixdof::cli
