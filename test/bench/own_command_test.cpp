#include "bench/common/own_command.h"

#include <cerrno>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

/// Gives this process another name, until its end.
class Named {
 public:
  explicit Named(const char* name) : before_(program_invocation_short_name) {
    program_invocation_short_name = const_cast<char*>(name);
  }
  ~Named() { program_invocation_short_name = before_; }
  Named(const Named&) = delete;
  Named& operator=(const Named&) = delete;

 private:
  char* before_;
};

TEST(OwnCommand, IsUnchangedInThisProjectsPrograms) {
  for (const char* const name : {"sixdof", "sixdof-bench", "test_bench"}) {
    const Named named(name);
    EXPECT_EQ(own_command("sixdof query --a x"), "sixdof query --a x") << name;
    EXPECT_EQ(own_command("sixdof-bench --a x"), "sixdof-bench --a x") << name;
    EXPECT_EQ(own_bench_program(), "sixdof-bench") << name;
  }
}

TEST(OwnCommand, HasTheNamesOfAProjectOfNewAlgorithm) {
  for (const char* const name : {"turbo-bvh-sixdof", "turbo-bvh-bench"}) {
    const Named named(name);
    EXPECT_EQ(own_command("sixdof query --a x"), "turbo-bvh-sixdof query --a x") << name;
    EXPECT_EQ(own_command("sixdof-bench --a x"), "turbo-bvh-bench --a x") << name;
    EXPECT_EQ(own_command("python3 x.py"), "python3 x.py") << name;
    EXPECT_EQ(own_bench_program(), "turbo-bvh-bench") << name;
  }
}

}  // namespace
}  // namespace sixdof
