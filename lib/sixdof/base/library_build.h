#pragma once

#include <string>

namespace sixdof {

/// How this library was compiled. An embedder that sets no build type gets it without optimisation, and times of such a
/// build mean nothing.
enum class LibraryBuild {
  release,
  with_assertions,  ///< Optimised, assertions on.
  unoptimised
};

LibraryBuild library_build();

/// "release", "debug (optimised)", "debug (unoptimised)".
std::string to_string(LibraryBuild build);

}  // namespace sixdof
