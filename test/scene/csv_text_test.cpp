#include <sixdof/scene/csv_text.h>

#include <fstream>

#include "../cli/scratch_folder.h"
#include "small_scenes.h"

namespace sixdof::scene {
namespace {

using Cells = std::vector<std::string>;

class CsvTextTest : public test::ScratchFolder {
 protected:
  std::vector<CsvText::Row> read(const std::string& text) {
    std::ofstream(path("t.csv"), std::ios::binary) << text;
    CsvText csv(path("t.csv"));
    std::vector<CsvText::Row> rows;
    for (CsvText::Row row; csv.next(row);) rows.push_back(row);
    return rows;
  }
  std::string refuses(const std::string& text) {
    const std::string message = message_of<BadFile>([&] { read(text); });
    EXPECT_TRUE(message.starts_with(path("t.csv") + ": ")) << message;
    return message.substr(path("t.csv").size() + 2);
  }
};

TEST_F(CsvTextTest, CountsLinesWhateverEndsThem) {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    const std::string e = end;
    const auto rows = read("a,b" + e + e + "# c" + e + " 1 ,2" + e + "," + e + "3,4");
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].cells, (Cells{"a", "b"}));
    EXPECT_EQ(rows[1].cells, (Cells{"1", "2"}));
    EXPECT_EQ(rows[1].line, 4u);
    EXPECT_EQ(rows[2].line, 6u);
  }
}

TEST_F(CsvTextTest, ReadsQuotedCells) {
  const auto rows = read("a,b,c\n\"x, \"\"y\"\"\" , \"\",\" z \"\n\"#1\",\"2;\t\",3\n");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1].cells, (Cells{"x, \"y\"", "", " z "}));
  EXPECT_EQ(rows[2].cells, (Cells{"#1", "2;\t", "3"}));
  EXPECT_EQ(refuses("a,b\n1,\"2\n3,4\n"), "line 2: a quote does not end in its line");
  EXPECT_EQ(refuses("a,b\n\"1\"2,3\n"), "line 2: text behind a quote: '2'");
  EXPECT_EQ(refuses("a,b\n\"\"\n\"x\"\"\n"), "line 3: a quote does not end in its line");
}

TEST_F(CsvTextTest, FindsTheSeparatorInTheFirstRow) {
  EXPECT_EQ(read("a;b\n1,5;2\n")[1].cells, (Cells{"1,5", "2"}));
  EXPECT_EQ(read("a\tb\tc\n\t 2\t\n")[1].cells, (Cells{"", "2", ""}));
  EXPECT_EQ(read("sep=;\na;b,c\n")[0].cells, (Cells{"a", "b,c"}));
  EXPECT_EQ(read("a\n1\n")[1].cells, (Cells{"1"}));
  EXPECT_EQ(refuses("a;b,c\n"), "line 1: columns are separated by commas and by semicolons; take one");
  EXPECT_EQ(refuses("\na,b\tc\n"), "line 2: columns are separated by commas and by tabs; take one");
}

TEST_F(CsvTextTest, RefusesWhatIsNoTextInUtf8) {
  EXPECT_EQ(read("\xEF\xBB\xBF\"a\",b\n")[0].cells, (Cells{"a", "b"}));
  EXPECT_EQ(refuses(std::string("\xFF\xFE"
                                "a\0,\0",
                                6)),
            "is text in UTF-16; save it as UTF-8");
  EXPECT_EQ(refuses(std::string("\xFE\xFF\0a", 4)), "is text in UTF-16; save it as UTF-8");
  EXPECT_EQ(refuses(std::string("a,b\n1,\0", 7)), "line 2: has a byte 0, so it is no text");
  EXPECT_NE(message_of<BadFile>([&] { CsvText(path("none.csv")); }).find("cannot be read"), std::string::npos);
  EXPECT_NE(message_of<BadFile>([&] { CsvText(path("")); }).find("cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace sixdof::scene
