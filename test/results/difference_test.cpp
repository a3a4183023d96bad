#include <sixdof/results/difference.h>

#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "result_rows.h"

namespace sixdof::results {
namespace {

using test::Json;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Json row(const char* algorithm, const Json& values = Json::object()) {
  return test::row("distance", algorithm, "p", "distance", 5.0, 100.0, values);
}

Differences between(const std::vector<Json>& before, const std::vector<Json>& after, const Json& context_before = {},
                    const Json& context_after = {}) {
  Results results;
  parse_results(test::file_of(before, context_before), "before.json", results);
  parse_results(test::file_of(after, context_after), "after.json", results);
  return differences(results, row_groups(results), 0, 1);
}

std::vector<std::string> texts(const Differences& found) {
  std::vector<std::string> list;
  for (const Difference& each : found.values) {
    list.push_back(each.counter + (each.kind == MetricKind::work ? " (work): " : ": ") + to_string(each));
  }
  return list;
}

TEST(Differences, AreAnswersAndWorkBeyondRounding) {
  const Differences found = between(
      {row("x", {{"error_max", 1e-3}, {"error_rms", 1e-16}, {"nodes_tested", 10}, {"p99_ns", 1}, {"bytes", 8}})},
      {row("x", {{"error_max", 2e-3}, {"error_rms", 9e-13}, {"nodes_tested", 20}, {"p99_ns", 2}, {"mismatch", 3}})});
  EXPECT_THAT(texts(found), ElementsAre("bytes (work): 8 -> none", "error_max: 0.001 -> 0.002", "mismatch: 0 -> 3",
                                        "nodes_tested (work): 10 -> 20"));
  EXPECT_EQ(found.changed_answers(), 2u);
  EXPECT_EQ(found.common_rows, 1u);
}

TEST(Differences, ShowTheDigitsThatDiffer) {
  const Differences found = between({row("x", {{"error_max", 0.199575}, {"gamma_F_deg", 1.0}})},
                                    {row("x", {{"error_max", 0.199575001}, {"gamma_F_deg", 2.0}})});
  EXPECT_THAT(texts(found), ElementsAre("error_max: 0.199575 -> 0.199575001", "gamma_F_deg: 1 -> 2"));
}

TEST(Differences, OfRepetitionsAreBeyondTheirRange) {
  const auto repeated = [](double least, double largest) {
    return std::vector{row("x", {{"error_max", least}}), row("x", {{"error_max", largest}})};
  };
  EXPECT_THAT(texts(between(repeated(1.0, 3.0), repeated(2.0, 4.0))), IsEmpty());
  EXPECT_THAT(texts(between(repeated(1.0, 2.0), repeated(3.0, 4.0))), ElementsAre("error_max: 1 to 2 -> 3 to 4"));
}

TEST(Differences, OfOtherConfigurationsAreTheirNumberAlone) {
  EXPECT_THAT(
      texts(between({row("x", {{"error_max", 1.0}})}, {row("x", {{"error_max", 2.0}, {"configurations", 32}})})),
      ElementsAre("configurations: 64 -> 32"));
}

TEST(Differences, AreRowsOfOneSideAndErrors) {
  Json broken = row("x");
  broken.update({{"error_occurred", true}, {"error_message", "it broke"}});
  const Differences found = between({row("x"), row("y")}, {broken, row("z")});
  EXPECT_THAT(texts(found), ElementsAre("error: none -> it broke"));
  EXPECT_THAT(found.only_before, ElementsAre(row("y").at("name")));
  EXPECT_THAT(found.only_after, ElementsAre(row("z").at("name")));
}

TEST(Differences, AreBeyondTheToleranceThatIsGiven) {
  Results results;
  parse_results(test::file_of({row("x", {{"error_max", 1.0}, {"error_rms", 1.0}})}), "before.json", results);
  parse_results(test::file_of({row("x", {{"error_max", 1.009}, {"error_rms", 1.02}})}), "after.json", results);
  EXPECT_THAT(texts(differences(results, row_groups(results), 0, 1, 0.01)), ElementsAre("error_rms: 1 -> 1.02"));
  EXPECT_EQ(differences(results, row_groups(results), 0, 1).changed_answers(), 2u);
}

TEST(Differences, AreWorseByTheDirectionOfTheirMetric) {
  const auto verdict = [](const char* counter, std::optional<double> before, std::optional<double> after) {
    const auto range = [](std::optional<double> value) {
      return value ? std::optional(Range{*value, *value}) : std::nullopt;
    };
    return is_worse({"row", counter, MetricKind::answer, range(before), range(after)});
  };
  EXPECT_EQ(verdict("mismatch", 0.0, 1.0), true);
  EXPECT_EQ(verdict("mismatch", 2.0, 1.0), false);
  EXPECT_EQ(verdict("crashed", std::nullopt, 1.0), true) << "absent for none";
  EXPECT_EQ(verdict("fill_a", 0.9, 0.8), true) << "higher is better";
  EXPECT_EQ(verdict("nu_F", 1.1, 0.8), true) << "nearer to 1 is better";
  EXPECT_EQ(verdict("gain_F", 1.0, 2.0), std::nullopt) << "describes";
  EXPECT_EQ(verdict("of_no_metric", 1.0, 2.0), std::nullopt);
  EXPECT_EQ(is_worse({"row", "error", MetricKind::answer, {}, {}, "", "it broke"}), true);
  EXPECT_EQ(is_worse({"row", "error", MetricKind::answer, {}, {}, "it broke", ""}), false);
}

TEST(Differences, AreVersionsAndSettings) {
  const Differences found =
      between({}, {}, {{"date", "today"}, {"algorithm:x", "1.0"}, {"fcl_build", "-O2"}},
              {{"date", "tomorrow"}, {"algorithm:x", "1.1"}, {"fcl_build", "-O2"}, {"settings:x", "size=1"}});
  ASSERT_EQ(found.versions.size(), 2u);
  EXPECT_EQ(found.versions[0].key + found.versions[0].before + found.versions[0].after, "algorithm:x1.01.1");
  EXPECT_EQ(found.versions[1].key + found.versions[1].before + found.versions[1].after, "settings:xsize=1");
}

}  // namespace
}  // namespace sixdof::results
