#include <sixdof/base/library_build.h>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

TEST(LibraryBuild, HasAWordForEveryKind) {
  EXPECT_EQ(to_string(LibraryBuild::release), "release");
  EXPECT_EQ(to_string(LibraryBuild::with_assertions), "debug (optimised)");
  EXPECT_EQ(to_string(LibraryBuild::unoptimised), "debug (unoptimised)");
}

TEST(LibraryBuild, IsThatOfItsTest) {
#if defined(__OPTIMIZE__)
  EXPECT_NE(library_build(), LibraryBuild::unoptimised);
#else
  EXPECT_EQ(library_build(), LibraryBuild::unoptimised);
#endif
}

}  // namespace
}  // namespace sixdof
