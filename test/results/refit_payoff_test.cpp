#include <sixdof/results/refit_payoff.h>

#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "result_rows.h"

namespace sixdof::results {
namespace {

using test::Json;

Json row(const std::string& algorithm, double amplitude, double ns, const std::string& family = "twist") {
  Json json =
      test::row("deform", algorithm, "", "distance", 1.0, 1.0, {{"processor_ns", ns}, {"amplitude", amplitude}});
  json["name"] = fmt::format("deform/{}/amplitude:{:g}/question:near/algorithm:{}", family, amplitude, algorithm);
  json["sixdof"].erase("bucket");
  json["sixdof"]["scenario"] = family;
  json["sixdof"]["question"] = "near";
  return json;
}

std::vector<Payoff> of(const std::vector<Json>& rows) {
  Results results;
  parse_results(test::file_of(rows), "run.json", results);
  return refit_payoffs(row_groups(results));
}

TEST(RefitPayoff, ComparesWithTheFastestRebuildOfTheSameLibrary) {
  const auto found = of({row("embree-refit", 3.0, 50.0), row("embree-rebuild", 3.0, 90.0),
                         row("embree-rebuild-fast", 3.0, 40.0), row("fcl-rebuild", 3.0, 1.0), row("exact", 3.0, 5.0),
                         row("exact-rebuild", 3.0, 6.0), row("ode-refit", 3.0, 7.0)});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].refit, "embree-refit");
  EXPECT_EQ(found[0].family, "twist");
  ASSERT_EQ(found[0].points.size(), 1u);
  EXPECT_EQ(found[0].points[0].rebuild_ns, 40.0);
  EXPECT_EQ(found[0].rebuild_wins_from(), std::optional(3.0));
  EXPECT_EQ(found[1].refit, "exact");
  EXPECT_EQ(found[1].rebuild_wins_from(), std::nullopt);
}

TEST(RefitPayoff, IsTheLeastAmplitudeFromWhichOnRebuildWins) {
  const auto from = [](const std::vector<double>& refit_ns) {
    std::vector<Json> rows;
    const double amplitudes[] = {30.0, 0.1, 3.0, 10.0};  // in no order
    for (std::size_t i = 0; i < refit_ns.size(); ++i) {
      rows.push_back(row("fcl-refit", amplitudes[i], refit_ns[i]));
      rows.push_back(row("fcl-rebuild", amplitudes[i], 10.0));
    }
    return of(rows).at(0).rebuild_wins_from();
  };
  EXPECT_EQ(from({20.0, 1.0, 2.0, 11.0}), std::optional(10.0));
  EXPECT_EQ(from({20.0, 12.0, 13.0, 11.0}), std::optional(0.1));
  EXPECT_EQ(from({20.0, 12.0, 2.0, 3.0}), std::optional(30.0));
  EXPECT_EQ(from({9.0, 12.0, 13.0, 11.0}), std::nullopt);
}

TEST(RefitPayoff, KeepsFamiliesApartAndLeavesOutFaults) {
  Json wrong = row("fcl-refit", 3.0, 1.0);
  wrong["error_occurred"] = true;
  wrong["error_message"] = "2 missed, 0 wrong";
  EXPECT_TRUE(of({wrong, row("fcl-rebuild", 3.0, 10.0)}).empty());
  const auto found = of({row("fcl-refit", 3.0, 1.0), row("fcl-rebuild", 3.0, 10.0), row("fcl-refit", 3.0, 20.0, "wave"),
                         row("fcl-rebuild", 3.0, 10.0, "wave")});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].rebuild_wins_from(), std::nullopt);
  EXPECT_EQ(found[1].rebuild_wins_from(), std::optional(3.0));
}

}  // namespace
}  // namespace sixdof::results
