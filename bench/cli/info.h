#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof info FILE_OR_NAME [--json]`: what a configuration set, a mesh file or a model holds.
void add_info_command(CLI::App& app);

}  // namespace sixdof::cli
