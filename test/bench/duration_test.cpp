#include "bench/common/duration.h"

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

TEST(Duration, NeedsANumberAndAUnit) {
  EXPECT_DOUBLE_EQ(parse_duration("--tau", "0.9ms"), 0.9e-3);
  EXPECT_DOUBLE_EQ(parse_duration("--tau", "10min"), 600.0);
  EXPECT_DOUBLE_EQ(parse_duration("--tau", "2h"), 7200.0);
  EXPECT_DOUBLE_EQ(parse_duration("--tau", "1e3us"), 1e-3);
  for (const char* bad : {"", "10", "ms", "0ms", "-1s", "1 s", "1sec", "nans", "infs", "1,5s"}) {
    EXPECT_THROW(parse_duration("--tau", bad), BadArgument) << bad;
  }
}

TEST(Duration, IsPrintedInItsOwnUnit) {
  EXPECT_EQ(duration_text(0.9e-3), "900 us");
  EXPECT_EQ(duration_text(12e-6), "12 us");
  EXPECT_EQ(duration_text(90.0), "1.5 min");
  EXPECT_EQ(duration_text(1e-12), "0.001 ns");
  EXPECT_EQ(duration_text(999.4e-9), "999 ns");
  EXPECT_EQ(duration_text(999.7e-9), "1 us");
  EXPECT_EQ(duration_text(999.7e-3), "1 s");
}

}  // namespace
}  // namespace sixdof
