#include <sixdof/base/library_build.h>

namespace sixdof {

LibraryBuild library_build() {
#if !defined(__OPTIMIZE__)
  return LibraryBuild::unoptimised;
#elif defined(NDEBUG)
  return LibraryBuild::release;
#else
  return LibraryBuild::with_assertions;
#endif
}

std::string to_string(LibraryBuild build) {
  switch (build) {
    case LibraryBuild::release:
      return "release";
    case LibraryBuild::with_assertions:
      return "debug (optimised)";
    case LibraryBuild::unoptimised:
      break;
  }
  return "debug (unoptimised)";
}

}  // namespace sixdof
