#include <sixdof/algorithm/ist/clearance_model.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "../../oracle/instruction_sets.h"
#include "random_spheres.h"

namespace sixdof::ist {
namespace {

/// The obstacles of one slot.
std::vector<Obstacle> some_obstacles(Draws& draws, std::size_t count) {
  std::vector<Obstacle> list;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_plane = draws.uniform(0.0, 1.0) < 0.5;
    list.push_back({draws.point(1.0), is_plane ? draws.point(1.0).normalized() : Eigen::Vector3d::Zero(),
                    is_plane ? 0.0 : draws.uniform(0.01, 0.5)});
  }
  return list;
}

double modelled(const std::vector<Obstacle>& obstacles, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Obstacle& o : obstacles) least = std::min(least, o.distance(p));
  return least;
}

/// The same search for one slot, written plainly.
std::pair<Eigen::Vector3d, double> maximised(const std::vector<Obstacle>& obstacles, const Eigen::Vector3d& start,
                                             double trust) {
  Eigen::Vector3d p = start, best = start;
  double length = 0.5 * trust;
  for (int i = 0; i < 40; ++i, length *= 0.88) {
    const auto nearest = std::ranges::min_element(obstacles, {}, [&](const Obstacle& o) { return o.distance(p); });
    p += nearest->away(p) * length;
    if (const double out = (p - start).norm(); out > trust) p = start + (p - start) * (trust / out);
    if (modelled(obstacles, p) > modelled(obstacles, best)) best = p;
  }
  return {best, modelled(obstacles, best)};
}

/// Slots hold one obstacle to more than fit, of which the latest count.
TEST(ClearanceModels, FindThePlainSearchsBitsOnEveryInstructionSet) {
  const int sets = for_each_instruction_set([] {
    Draws draws(3);
    ClearanceModels models;
    int moved = 0;
    for (int round = 0; round < 50; ++round) {
      std::vector<std::vector<Obstacle>> obstacles;
      std::vector<std::pair<Eigen::Vector3d, double>> starts;
      for (std::size_t s = 0; s < ClearanceModels::k_slots; ++s) {
        obstacles.push_back(some_obstacles(draws, 1 + (s + static_cast<std::size_t>(round)) % 12));
        starts.emplace_back(draws.point(1.0), draws.uniform(0.01, 1.0));
        models.reset(s);
        for (const Obstacle& o : obstacles[s]) models.add(s, o);
        models.set_start(s, starts[s].first, starts[s].second);
        if (obstacles[s].size() > ClearanceModels::k_obstacles) {
          obstacles[s].erase(obstacles[s].begin(), obstacles[s].end() - ClearanceModels::k_obstacles);
        }
      }
      models.maximise();
      for (std::size_t s = 0; s < ClearanceModels::k_slots; ++s) {
        const auto expected = maximised(obstacles[s], starts[s].first, starts[s].second);
        ASSERT_EQ(models.place(s), expected.first) << round << ' ' << s;
        ASSERT_EQ(models.clearance(s), expected.second) << round << ' ' << s;
        if (models.place(s) != starts[s].first) ++moved;
      }
    }
    EXPECT_GT(moved, 200);
  });
  EXPECT_GE(sets, 2);
}

}  // namespace
}  // namespace sixdof::ist
