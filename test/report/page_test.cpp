// The page as a file: results are data in it and nothing else.

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/report/page.h>

#include "result_text.h"

namespace sixdof::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::filesystem::path k_sources = SIXDOF_REPORT_SOURCES;

/// The page's own files with stand-ins for the libraries.
class Page : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() /
             (std::string("sixdof-page-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder / "vendor");
    std::filesystem::create_directory_symlink(k_sources / "page", folder / "page");
    std::filesystem::create_directory_symlink(k_sources / "figures", folder / "figures");
    for (const char* const name : {"vega", "vega-lite", "vega-embed", "three"}) {
      std::ofstream(folder / "vendor" / (std::string(name) + ".min.js"))
          << "var library = '</script><b>';export{library as Library};";
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::filesystem::path folder;
};

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++n;
  return n;
}

TEST_F(Page, HostileTextsAreInertData) {
  const std::string hostile = "</script><img src=x onerror=alert(1)>'\"";
  const Results results = test::results_of({test::row("distance", hostile, hostile, "distance", 5.0, 1.0),
                                            test::row("distance", "exact", "{{scripts}}", "distance", 5.0, 1.0)},
                                           {{"commit", hostile}});
  const PageFiles files = read_page_files(folder);
  const std::string html = page_html(make_report(results, {}), files);
  EXPECT_THAT(html, Not(HasSubstr("<img")));
  EXPECT_THAT(html, HasSubstr("\\u003cimg src=x onerror=alert(1)"));
  EXPECT_EQ(count(html, "<script"), count(html, "</script>")) << "no element is ended by a library or a result";
  EXPECT_GE(count(html, "{{scripts}}"), 1u) << "a name is no place";
}

TEST_F(Page, DataAreJsonWithEveryTableThatFiguresAndPagesName) {
  const Results results = test::results_of({test::row("distance", "exact", "p", "distance", 5.0, 1.0)});
  const test::Json data = test::Json::parse(page_data(make_report(results, {}), read_page_files(folder)));
  ASSERT_GE(data["figures"].size(), 10u);
  for (const auto& [id, figure] : data["figures"].items()) {
    const std::string table = figure["usermeta"]["table"];
    if (table == "history") continue;  // of sixdof history
    ASSERT_TRUE(data["tables"].contains(table)) << id;
    for (const auto& filter : figure["usermeta"]["filters"]) {
      const auto& columns = data["tables"][table]["columns"];
      if (data["tables"][table]["rows"].empty()) continue;
      EXPECT_NE(std::find(columns.begin(), columns.end(), filter["field"]), columns.end()) << id << filter;
    }
  }
  for (const auto& page : data["pages"]) {
    EXPECT_FALSE(page["command"].get<std::string>().empty()) << "a page without data says what makes them";
    for (const auto& figure : page["figures"]) EXPECT_TRUE(data["figures"].contains(figure)) << figure;
    for (const auto& table : page["tables"]) EXPECT_TRUE(table == "history" || data["tables"].contains(table)) << table;
  }
}

TEST_F(Page, RunsOnABusyMachineAreMarked) {
  const auto is_busy = [&](const test::Json& context) {
    const Results results = test::results_of({test::row("distance", "exact", "p", "distance", 5.0, 1.0)}, context);
    const test::Json data = test::Json::parse(page_data(make_report(results, {}), read_page_files(folder)));
    EXPECT_EQ(data["runs"].size(), 1u);
    return data["runs"][0]["is_busy"].get<bool>();
  };
  EXPECT_TRUE(is_busy({{"num_cpus", 2}, {"load_avg", {1.1, 0.0, 0.0}}}));
  EXPECT_FALSE(is_busy({{"num_cpus", 2}, {"load_avg", {0.9, 8.0, 8.0}}})) << "the last minute counts";
  EXPECT_FALSE(is_busy({{"load_avg", {9.0}}})) << "of how many processors is not known";
  EXPECT_FALSE(is_busy({{"num_cpus", 2}, {"load_avg", "high"}}));
}

TEST_F(Page, BytesThatAreNoTextDoNotStopIt) {
  Results results = test::results_of({test::row("distance", "exact", "p", "distance", 5.0, 1.0)});
  results.rows[0].fields.pair = "\xff\xfe";
  EXPECT_THAT(page_html(make_report(results, {}), read_page_files(folder)), HasSubstr("\xEF\xBF\xBD"));
}

TEST_F(Page, MissingLibraryIsNamedWithTheWayToIt) {
  std::filesystem::remove(folder / "vendor" / "vega-lite.min.js");
  try {
    read_page_files(folder);
    FAIL();
  } catch (const BadFile& e) {
    EXPECT_THAT(e.what(), HasSubstr("vendor/vega-lite.min.js: is missing"));
    EXPECT_THAT(e.what(), HasSubstr("cmake/setup report"));
  }
}

}  // namespace
}  // namespace sixdof::report
