#include <sixdof/scenario/evaluation.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace sixdof {
namespace {

constexpr double k_rounding = 1e-12;

/// An answer that depends on the number of the query.
class Scripted final : public Query {
 public:
  Outcome<Response> respond(const Pose& X_AB) override {
    Response response;
    response.penalty = 0.5;
    response.force = {1.0, 2.0, 3.0};
    response.torque = {-1.0, 0.5, 0.25};
    response.reference = X_AB.t;  // B's origin
    switch (calls_++) {
      case 2:
        return fail(Status::failed, "no convergence");
      case 3:
        throw std::runtime_error("out of bounds");
      case 4:
        response.torque.y() = std::numeric_limits<double>::quiet_NaN();
        return response;
      case 5:
        throw 7;
      default:
        return response;
    }
  }

 private:
  int calls_ = 0;
};

TEST(Recorder, EveryStepIsRecordedWhateverTheQueryDoes) {
  const auto scenario = make_scenario("IV");
  Scripted query;
  const Recording recording = record(*scenario, query, 8);
  // The untimed first query is number 0.
  const std::vector<Status> expected{Status::ok,     Status::failed, Status::failed, Status::non_finite,
                                     Status::failed, Status::ok,     Status::ok,     Status::ok};
  EXPECT_EQ(recording.status, expected);
  EXPECT_EQ(recording.first_failure, "failed: no convergence");
  EXPECT_EQ(recording.size(), 8u);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_GT(recording.times_ns[k], 0.0);
    EXPECT_EQ(recording.progress[k], scenario->steps(8)[k]);
    EXPECT_EQ(recording.forces[k].norm() > 0.0, expected[k] == Status::ok);
    EXPECT_EQ(recording.penalties[k], expected[k] == Status::ok ? 0.5 : 0.0);
  }
}

/// Computes, or sleeps, for some milliseconds per query.
class Busy final : public Query {
 public:
  explicit Busy(bool works) : works_(works) {}
  Outcome<Response> respond(const Pose&) override {
    constexpr double k_seconds = 0.004;
    if (!works_) {
      std::this_thread::sleep_for(std::chrono::duration<double>(k_seconds));
      return Response{};
    }
    const std::clock_t start = std::clock();
    while (static_cast<double>(std::clock() - start) < k_seconds * CLOCKS_PER_SEC) {
    }
    return Response{};
  }

 private:
  bool works_;
};

TEST(Recorder, ProcessorTimeExcludesWaiting) {
  const auto scenario = make_scenario("II");
  Busy working(true);
  Busy waiting(false);
  const double worked = record(*scenario, working, 10).processor_ns;
  EXPECT_GT(worked, 3.9e6);
  EXPECT_LT(worked, 12e6);  // a mean, not a sum of ten
  EXPECT_LT(record(*scenario, waiting, 10).processor_ns, 0.5 * worked);
}

TEST(Recorder, TorqueIsAboutTheScenariosReference) {
  const auto scenario = make_scenario("IV");
  Scripted query;
  const Recording recording = record(*scenario, query, 8);
  // Answered about B's origin, recorded about the point 20 below it: T + (0, 0, 20) x F.
  const Eigen::Vector3d expected(-1.0 - 20.0 * 2.0, 0.5 + 20.0 * 1.0, 0.25);
  EXPECT_TRUE(recording.torques[0].isApprox(expected, k_rounding));
  std::string diagnosis;
  Scripted fresh;
  EXPECT_TRUE(respond_at(*scenario, fresh, 0.3, diagnosis).value.torque.isApprox(expected, k_rounding));
}

TEST(Recorder, ReportsAnAlgorithmWithoutResponses) {
  const auto scenario = make_scenario("II");
  Query mute;
  const Recording recording = record(*scenario, mute, 3);
  EXPECT_EQ(recording.status, std::vector<Status>(3, Status::unsupported));
  EXPECT_EQ(recording.first_failure, "unsupported: the algorithm gives no such answer");
}

}  // namespace
}  // namespace sixdof
