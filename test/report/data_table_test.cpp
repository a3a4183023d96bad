// Tables as CSV and Markdown.

#include <cmath>

#include <gtest/gtest.h>

#include <sixdof/report/data_table.h>

namespace sixdof::report {
namespace {

DataTable table_of(const std::string& text) {
  return {.name = "t", .title = "A <title>", .columns = {"x_us", "a|b"}, .rows = {{1234567.0, text}, {Cell(), Cell()}}};
}

TEST(DataTable, CsvQuotesWhatNeedsIt) {
  EXPECT_EQ(as_csv(table_of("a,\"b\"\n")), "x_us,a|b\r\n1.23457e+06,\"a,\"\"b\"\"\n\"\r\n,\r\n");
  EXPECT_EQ(as_csv(table_of("plain")), "x_us,a|b\r\n1.23457e+06,plain\r\n,\r\n");
}

TEST(DataTable, CsvHasNoFormulas) {
  EXPECT_EQ(as_csv(table_of("=1+1")), "x_us,a|b\r\n1.23457e+06,'=1+1\r\n,\r\n");
  DataTable negative = table_of("x");
  negative.rows = {{-0.5, std::string("-x")}};
  EXPECT_EQ(as_csv(negative), "x_us,a|b\r\n-0.5,'-x\r\n") << "a negative number is no formula";
}

TEST(DataTable, NumbersThatAreNoneAreEmpty) {
  DataTable table = table_of("x");
  table.rows = {{std::nan(""), std::string("x")}, {HUGE_VAL, std::string("y")}};
  EXPECT_EQ(as_csv(table), "x_us,a|b\r\n,x\r\n,y\r\n");
}

TEST(DataTable, MarkdownEscapesMarkup) {
  EXPECT_EQ(as_markdown(table_of("<b>*x*|y\n")),
            "### A &lt;title>\n\n| x\\_us | a\\|b |\n|---:|---|\n| 1.23457e+06 | &lt;b>\\*x\\*\\|y  |\n|  |  |\n");
}

}  // namespace
}  // namespace sixdof::report
