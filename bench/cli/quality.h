#pragma once

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof quality --scenario II --algorithm NAME`: the response of one algorithm along one scenario against the ideal,
/// as measures (text or JSON) and as a series (HDF5); `--draw FILE.svg` draws the scenario instead.
void add_quality_command(CLI::App& app);

}  // namespace sixdof::cli
