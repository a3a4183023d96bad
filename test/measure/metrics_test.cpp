#include <sixdof/measure/metrics.h>

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

TEST(Metrics, NamesAreUniqueAndReadable) {
  std::set<std::string_view> names;
  for (const Metric& m : metrics()) {
    EXPECT_TRUE(names.insert(m.name).second) << m.name;
    EXPECT_FALSE(m.unit.empty()) << m.name;
    EXPECT_FALSE(m.meaning.empty()) << m.name;
    EXPECT_FALSE(m.source.empty()) << m.name;
    EXPECT_TRUE(std::all_of(m.name.begin(), m.name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; }))
        << m.name;
    EXPECT_EQ(&metric(m.name), &m);
  }
}

TEST(Metrics, WholePathVariantsAreTheSameMeasure) {
  EXPECT_EQ(metric("gamma_F_deg_all").name, "gamma_F_deg");
  EXPECT_EQ(metric("gamma_F_deg_all").unit, "degree");
  EXPECT_EQ(metric("sigma_T_by_wall_traction").name, "sigma_T");
  EXPECT_EQ(metric("sigma_F_all_by_depth").name, "sigma_F");
  EXPECT_THROW(metric("_by_depth"), BadArgument);
  EXPECT_EQ(to_string(metric("nu_F").better), "nearer 1");
  EXPECT_EQ(to_string(metric("sigma_F").better), "lower");
  EXPECT_THROW(metric("sigma"), BadArgument);
  EXPECT_THROW(metric("_all"), BadArgument);
}

}  // namespace
}  // namespace sixdof
