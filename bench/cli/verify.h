#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof verify FILE [--sample N] [--seed S] [--oracle NAME]`: measures a sample of every bucket of a configuration
/// set again and prints a table; fails if anything is wrong.
void add_verify_command(CLI::App& app);

}  // namespace sixdof::cli
