// Times over many files: order, change points, machines.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>
#include <sixdof/report/history.h>

#include "result_text.h"

namespace sixdof::report {
namespace {

constexpr double k_rounding = 1e-12;  // of one quotient

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<double> noisy(unsigned seed, const std::vector<double>& levels, std::size_t each) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0.0, 0.04);
  std::vector<double> values;
  for (const double level : levels) {
    for (std::size_t k = 0; k < each; ++k) values.push_back(std::log(level) + noise(generator));
  }
  return values;
}

TEST(ChangePoints, PlantedChangesAreFoundWhereTheyAre) {
  EXPECT_THAT(change_points(noisy(3, {100.0, 130.0}, 12)), ElementsAre(12));
  EXPECT_THAT(change_points(noisy(4, {100.0, 150.0, 80.0}, 10)), ElementsAre(10, 20));
}

TEST(ChangePoints, NoiseIsNone) {
  std::size_t found = 0;
  for (unsigned seed = 0; seed < 50; ++seed) found += change_points(noisy(seed, {100.0}, 20)).size();
  EXPECT_LE(found, 2u) << "of 50 series of 20 values";
  EXPECT_THAT(change_points({}), IsEmpty());
  EXPECT_THAT(change_points({1.0}), IsEmpty());
  EXPECT_THAT(change_points({0.0, 0.05}), IsEmpty()) << "less than a tenth";
}

class HistoryFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() /
             (std::string("sixdof-history-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  void write(const std::string& name, const std::string& date, const std::string& machine, double ns) const {
    std::ofstream(folder / name) << test::file_of({test::row("distance", "exact", "p", "distance", 5.0, ns)},
                                                  {{"date", date}, {"host_name", machine}, {"commit", "abc"}});
  }

  std::filesystem::path folder;
};

TEST_F(HistoryFolder, FilesStandInTheOrderOfTheirDates) {
  write("a.json", "2026-02-01", "m", 2000.0);
  write("b.json", "2026-01-01", "m", 1000.0);
  std::ofstream(folder / "other.json") << "{}";
  std::ofstream(folder / "text.txt") << "no result";
  const Results results = read_folder(folder);
  const DataTable table = history_table(results, row_groups(results));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(test::number_in(table, table.rows[0], "time_us"), 1.0);
  EXPECT_EQ(test::number_in(table, table.rows[1], "time_us"), 2.0);
}

TEST_F(HistoryFolder, AnotherMachineIsNoChange) {
  for (int k = 0; k < 6; ++k)
    write("a" + std::to_string(k) + ".json", "2026-01-0" + std::to_string(k + 1), "old", 1000.0);
  for (int k = 0; k < 6; ++k) {
    write("b" + std::to_string(k) + ".json", "2026-02-0" + std::to_string(k + 1), "new", k < 3 ? 3000.0 : 6000.0);
  }
  const Results results = read_folder(folder);
  const DataTable table = history_table(results, row_groups(results));
  ASSERT_EQ(table.columns[k_history_change], "change");
  std::vector<std::size_t> changed;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    if (std::holds_alternative<double>(table.rows[k][k_history_change])) changed.push_back(k);
  }
  ASSERT_THAT(changed, ElementsAre(9));
  EXPECT_NEAR(test::number_in(table, table.rows[9], "change"), 2.0, k_rounding);
  EXPECT_EQ(test::text_in(table, table.rows[5], "machine"), "machine 1");
  EXPECT_EQ(test::text_in(table, table.rows[6], "machine"), "machine 2");
}

TEST_F(HistoryFolder, FolderWithoutResultsIsRefused) {
  std::ofstream(folder / "x.json") << "{}";
  try {
    read_folder(folder);
    FAIL();
  } catch (const BadFile& e) {
    EXPECT_THAT(e.what(), HasSubstr("has no result of sixdof-bench"));
  }
  EXPECT_THROW(read_folder(folder / "absent"), BadFile);
}

}  // namespace
}  // namespace sixdof::report
