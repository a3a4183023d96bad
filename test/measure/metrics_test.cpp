#include <sixdof/measure/metrics.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

TEST(Metrics, NamesAreUniqueAndReadable) {
  std::set<std::string_view> names;
  for (const Metric& m : metrics()) {
    EXPECT_TRUE(names.insert(m.name).second) << m.name;
    EXPECT_FALSE(m.unit.empty()) << m.name;
    EXPECT_FALSE(m.meaning.empty()) << m.name;
    EXPECT_FALSE(m.source.empty()) << m.name;
    EXPECT_TRUE(std::all_of(m.name.begin(), m.name.end(), [](unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '*';
    })) << m.name;
    EXPECT_EQ(find_metric(m.name), &m);
  }
}

std::string name_of(std::string_view counter) {
  const Metric* const metric = find_metric(counter);
  return metric == nullptr ? "none" : std::string(metric->name);
}

TEST(Metrics, SuffixesBelongToTheSameMetric) {
  EXPECT_EQ(name_of("gamma_F_deg_low"), "gamma_F_deg");
  EXPECT_EQ(name_of("cpu_time_high"), "cpu_time");
  EXPECT_EQ(name_of("gamma_F_deg_all"), "gamma_F_deg");
  EXPECT_EQ(name_of("sigma_T_by_wall_traction"), "sigma_T");
  EXPECT_EQ(name_of("sigma_F_all_by_depth"), "sigma_F");
  for (const char* none : {"_by_depth", "_all", "sigma", "sigma_F_almost", ""})
    EXPECT_EQ(name_of(none), "none") << none;
}

TEST(Metrics, EveryUnitOfWorkHasItsCounters) {
  EXPECT_EQ(name_of("points_tested"), "*_tested");
  EXPECT_EQ(name_of("sphere_pairs_total"), "*_total");
  EXPECT_EQ(name_of("ns_per_sphere_pairs"), "ns_per_*");
  EXPECT_EQ(name_of("ns_per_configuration"), "ns_per_configuration");
  EXPECT_EQ(name_of("points_left"), "none");
}

TEST(Metrics, DirectionsDecideWhatIsBetter) {
  EXPECT_EQ(to_string(find_metric("nu_F")->better), "nearer 1");
  EXPECT_EQ(to_string(find_metric("sigma_F")->better), "lower");
  EXPECT_TRUE(is_better(Better::lower, 0.1, -0.2));
  EXPECT_FALSE(is_better(Better::lower, 0.2, 0.2));
  EXPECT_TRUE(is_better(Better::higher, 0.2, 0.1));
  EXPECT_TRUE(is_better(Better::nearer_one, 1.1, 0.8));
  EXPECT_FALSE(is_better(Better::neither, 1.0, 2.0));
}

}  // namespace
}  // namespace sixdof
