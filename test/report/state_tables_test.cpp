// What was measured and with what: failures, objects and settings.

#include <variant>

#include <gtest/gtest.h>

#include <sixdof/report/tables.h>

#include "result_text.h"

namespace sixdof::report {
namespace {

using test::number_in;
using test::text_in;

TEST(FailuresTable, NamesFaultAndCommand) {
  const Results results = test::results_of({test::row("distance", "ode", "p", "distance", 5.0, 1.0, {{"mismatch", 7}}),
                                            test::row("distance", "exact", "p", "distance", 5.0, 1.0)},
                                           {{"seed", "1"}});
  const DataTable table = failures_table(results, row_groups(results));
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(text_in(table, table.rows[0], "fault"), "7 of 64 wrong");
  EXPECT_EQ(text_in(table, table.rows[0], "bucket"), "distance 5 %");
  EXPECT_NE(text_in(table, table.rows[0], "command").find("algorithm:ode"), std::string::npos);
}

TEST(ObjectsTable, HasTrianglesOfModelsAndHashesOfAll) {
  const Results results = test::results_of({}, {{"mesh:torus-1k", "abc"}, {"mesh:no-such-model@1", "def"}});
  const DataTable table = objects_table(results);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_NEAR(number_in(table, table.rows[0], "triangles"), 1000.0, 100.0);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(test::cell(table, table.rows[1], "triangles")));
  EXPECT_EQ(text_in(table, table.rows[1], "content_hash"), "def");
}

TEST(SettingsTable, CountsTheRowsOfEveryAlgorithm) {
  auto row = test::row("distance", "ode", "p", "distance", 5.0, 1.0);
  row["sixdof"]["settings"] = {{"combine", "mean"}};
  const Results results =
      test::results_of({row}, {{"algorithm:ode", "0.16"}, {"settings:ode", "combine=mean"}, {"algorithm:vps", "1"}});
  const DataTable table = settings_table(results);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(text_in(table, table.rows[0], "settings"), "combine=mean");
  EXPECT_EQ(number_in(table, table.rows[0], "in_rows"), 1.0);
  EXPECT_EQ(number_in(table, table.rows[1], "in_rows"), 0.0);
}

/// Along a scenario's path an algorithm may have another resolution than by default.
TEST(SettingsTable, HasTheSettingsOfRowsThatHaveOthers) {
  auto along_path = test::row("scenario", "ist", "p", "distance", 5.0, 1.0);
  along_path["sixdof"]["settings"] = {{"spheres", 150000}, {"fill", 1}};
  auto usual = test::row("respond", "ist", "p", "distance", 5.0, 1.0);
  usual["sixdof"]["settings"] = {{"spheres", 10000}, {"fill", 1.0}};
  const DataTable table = settings_table(
      test::results_of({along_path, usual}, {{"algorithm:ist", "1"}, {"settings:ist", "spheres=10000,fill=1.0"}}));
  ASSERT_EQ(table.rows.size(), 2u);
  for (const auto& row : table.rows) {
    EXPECT_EQ(number_in(table, row, "in_rows"), 1.0) << text_in(table, row, "settings");
  }
  EXPECT_EQ(text_in(table, table.rows[1], "settings"), "spheres=150000,fill=1");
}

}  // namespace
}  // namespace sixdof::report
