#include "bench/common/progress_line.h"

#include <gtest/gtest.h>

namespace sixdof {
namespace {

TEST(AsClock, RoundsToSeconds) {
  EXPECT_EQ(as_clock(0.4), "0:00:00");
  EXPECT_EQ(as_clock(451.0), "0:07:31");
  EXPECT_EQ(as_clock(36'000.0), "10:00:00");
}

TEST(CutToColumns, CountsCharactersAndNotBytes) {
  EXPECT_EQ(cut_to_columns("elephant", 20), "elephant");
  EXPECT_EQ(cut_to_columns("elephant", 8), "elephant");
  EXPECT_EQ(cut_to_columns("elephant", 3), "ele");
  EXPECT_EQ(cut_to_columns("\u00e9l\u00e9phant", 3), "\u00e9l\u00e9");
  EXPECT_EQ(cut_to_columns("", 3), "");
  EXPECT_EQ(cut_to_columns("elephant", 0), "");
}

}  // namespace
}  // namespace sixdof
