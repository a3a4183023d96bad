#include <sixdof/base/visible_text.h>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

TEST(VisibleText, ShowsEveryByteThatDoesNotPrint) {
  EXPECT_EQ(visible_text("v 0.5 -1e3"), "v 0.5 -1e3");
  EXPECT_EQ(visible_text("\xEF\xBB\xBFOFF"), "\\xEF\\xBB\\xBFOFF");
  EXPECT_EQ(visible_text(std::string_view("1\0", 2)), "1\\x00");
  EXPECT_EQ(visible_text("1\xC2\xA0"
                         "2\t\x7F"),
            "1\\xC2\\xA02\\x09\\x7F");
  EXPECT_EQ(visible_text(""), "");
}

TEST(VisibleText, CutsLongText) {
  EXPECT_EQ(visible_text(std::string(40, 'x')), std::string(40, 'x'));
  EXPECT_EQ(visible_text(std::string(41, 'x')), std::string(40, 'x') + "...");
  EXPECT_EQ(visible_text("abcdef", 3), "abc...");
}

}  // namespace
}  // namespace sixdof
