#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof info FILE_OR_NAME [--json]`: what is in a file. One entry of k_readers in info.cpp per kind of file;
/// whatever no other reader claims is a mesh file or a model's name.
void add_info_command(CLI::App& app);

}  // namespace sixdof::cli
