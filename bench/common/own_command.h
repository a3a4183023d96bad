#pragma once

#include <string>

namespace sixdof {

/// A command that begins with "sixdof" or "sixdof-bench", with the names of this program and its sibling in their
/// place: those of `sixdof new-algorithm turbo-bvh` are turbo-bvh-sixdof and turbo-bvh-bench.
std::string own_command(const std::string& command);

/// The name of the program that has the rows, beside this one: "sixdof-bench", "turbo-bvh-bench".
std::string own_bench_program();

}  // namespace sixdof
