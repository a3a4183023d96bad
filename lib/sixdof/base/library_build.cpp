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
  constexpr const char* k_names[] = {"release", "debug (optimised)", "debug (unoptimised)"};
  return k_names[static_cast<int>(build)];
}

}  // namespace sixdof
