#include <sixdof/results/frontier.h>

#include <gtest/gtest.h>

namespace sixdof::results {
namespace {

Tradeoff at(double cost, double error, double spread = 0.0) {
  return {{cost, cost * (1 - spread), cost * (1 + spread)}, {error, error * (1 - spread), error * (1 + spread)}};
}

TEST(Frontier, IsThatOfPareto) {
  const std::vector<Tradeoff> points{at(1, 9), at(2, 5), at(3, 6), at(4, 1), at(5, 1), at(2, 9)};
  EXPECT_EQ(frontier(points), (std::vector<bool>{true, true, false, true, false, false}));
}

TEST(Frontier, DoesNotRankPointsWhoseIntervalsOverlapInBoth) {
  EXPECT_FALSE(dominates(at(1.0, 1.0, 0.1), at(1.1, 1.1, 0.1)));
  EXPECT_TRUE(dominates(at(1.0, 1.0, 0.1), at(1.3, 1.1, 0.1)));
  EXPECT_FALSE(dominates(at(1.0, 1.2, 0.1), at(1.3, 1.1, 0.1))) << "the other one may be more exact";
  EXPECT_TRUE(dominates(at(1.1, 1.0, 0.1), at(1.1, 1.3, 0.1)));
}

TEST(Frontier, TakesErrorsOfRoundingForEqual) {
  EXPECT_TRUE(dominates(at(1, 9e-17), at(2, 4e-17)));
  EXPECT_FALSE(dominates(at(2, 4e-17), at(1, 9e-17)));
  EXPECT_FALSE(dominates(at(2, 1e-3), at(1, 9e-17)));
}

TEST(Frontier, HasNoFaultyPointAndNoneThatDominates) {
  Tradeoff faulty = at(1, 1);
  faulty.faulty = true;
  const std::vector<Tradeoff> points{faulty, at(2, 2)};
  EXPECT_EQ(frontier(points), (std::vector<bool>{false, true}));
}

TEST(Uncertain, ArePointsOfTheFrontierWithCostsThatOverlap) {
  // The first two are not told apart by cost; the third is far away; the fourth is dominated.
  const std::vector<Tradeoff> points{at(1.0, 4, 0.1), at(1.05, 3, 0.1), at(3, 1, 0.1), at(3.1, 5, 0.1)};
  EXPECT_EQ(frontier(points), (std::vector<bool>{true, true, true, false}));
  EXPECT_EQ(uncertain(points), (std::vector<bool>{true, true, false, false}));
}

TEST(Frontiers, OfInterpretedAlgorithmsAreTheirOwn) {
  const auto point = [](const char* algorithm, const char* runtime, double ns, double error) {
    return Row{.name = algorithm,
               .fields = {.query = "precision", .algorithm = algorithm, .runtime = runtime},
               .values = {{k_processor_mean, ns}, {"error_rms", error}}};
  };
  const std::vector<Row> points{point("a", "", 10, 0.5), point("b", "native", 5, 0.4), point("c", "python", 1, 0.1),
                                point("d", "python", 2, 0.2)};
  const std::vector<OnFrontier> on = frontiers(points, "cpu_time", "error_rms");
  EXPECT_FALSE(on[0].overall) << "b is compiled, faster and better";
  EXPECT_TRUE(on[1].overall) << "c is not compiled";
  EXPECT_TRUE(on[2].overall);
  EXPECT_FALSE(on[3].overall);
  EXPECT_TRUE(on[3].own);
}

}  // namespace
}  // namespace sixdof::results
