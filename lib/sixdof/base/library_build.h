#pragma once

#include <string>

namespace sixdof {

/// How this library was compiled. Without a CMake build type it is not optimised, and times of such a build mean
/// nothing.
enum class LibraryBuild {
  release,
  with_assertions,  ///< Optimised, assertions on.
  unoptimised
};

LibraryBuild library_build();

/// "release", "debug (optimised)", "debug (unoptimised)".
std::string to_string(LibraryBuild build);

}  // namespace sixdof
