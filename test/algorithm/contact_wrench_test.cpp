#include <sixdof/algorithm/contact_wrench.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

using Eigen::Vector3d;

ContactWrench wrench(const char* combine) {
  Settings settings({ContactWrench::combine_parameter()});
  settings.set("combine", combine);
  return ContactWrench(settings);
}

const Vector3d k_reference(0.5, -1.0, 2.0);
const Vector3d k_up(0, 0, 1), k_aside(0.6, 0.8, 0);

Response of_two_contacts(const char* combine) {
  ContactWrench w = wrench(combine);
  w.reset(k_reference);
  w.add({1.5, -1.0, 2.0}, k_up, 0.25);
  w.add({0.5, -1.0, 4.0}, k_aside, 0.75);
  EXPECT_EQ(w.count(), 2u);
  return w.response();
}

TEST(ContactWrench, CombinesByMeanSumOrTheDeepest) {
  // Torques by hand: (1,0,0) x (0,0,0.25) and (0,0,2) x (0.45,0.6,0).
  const Vector3d force = 0.25 * k_up + 0.75 * k_aside, torque = Vector3d(0, -0.25, 0) + Vector3d(-1.2, 0.9, 0);
  const Response sum = of_two_contacts("sum"), mean = of_two_contacts("mean"), deepest = of_two_contacts("deepest");
  EXPECT_TRUE(sum.force.isApprox(force));
  EXPECT_TRUE(sum.torque.isApprox(torque));
  EXPECT_TRUE(mean.force.isApprox(force / 2));
  EXPECT_TRUE(mean.torque.isApprox(torque / 2));
  EXPECT_TRUE(deepest.force.isApprox(0.75 * k_aside));
  EXPECT_TRUE(deepest.torque.isApprox(Vector3d(-1.2, 0.9, 0)));
  for (const Response& r : {sum, mean, deepest}) {
    EXPECT_EQ(r.penalty, 0.75);
    EXPECT_EQ(r.reference, k_reference);
    EXPECT_TRUE(std::isnan(r.volume));
  }
}

TEST(ContactWrench, ForgetsAtReset) {
  ContactWrench w = wrench("mean");
  w.reset(Vector3d::Zero());
  w.add({1, 2, 3}, k_up, 5.0);
  w.reset(k_reference);
  EXPECT_EQ(w.count(), 0u);
  EXPECT_EQ(w.response().force, Vector3d::Zero());
  EXPECT_EQ(w.response().penalty, 0.0);
  EXPECT_EQ(w.response().reference, k_reference);
}

TEST(ContactWrench, CountsAContactWithinAMarginAsDepthZero) {
  ContactWrench w = wrench("mean");
  w.reset(Vector3d::Zero());
  w.add({1, 0, 0}, k_up, 0.5);
  w.add({0, 1, 0}, k_up, -0.25);
  EXPECT_TRUE(w.response().force.isApprox(0.25 * k_up));
  EXPECT_EQ(w.response().penalty, 0.5);
}

TEST(ContactWrench, HidesNoNaN) {
  for (const char* combine : {"mean", "sum", "deepest"}) {
    ContactWrench w = wrench(combine);
    w.reset(Vector3d::Zero());
    w.add({1, 0, 0}, k_up, std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(w.response().force.allFinite()) << combine;
  }
}

}  // namespace
}  // namespace sixdof
