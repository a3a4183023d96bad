#include "bench/harness/guarded_query.h"

#include <limits>
#include <new>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace sixdof::bench {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinity = std::numeric_limits<double>::infinity();

class GivesUp final : public Query {
 public:
  Outcome<bool> collide(const Pose&) override { return fail(Status::failed, "gave up"); }
};

struct Guarded : ::testing::Test {
  /// The status of one question and, in `failures`, what was counted.
  Status ask(auto question) {
    failures = {};
    GuardedQuery guarded(query, question, failures);
    return guarded.ask(Pose()).status;
  }

  GivesUp query;
  Failures failures;
};

TEST_F(Guarded, LetsAnswersPass) {
  EXPECT_EQ(ask([](const Pose&) { return Outcome<bool>(true); }), Status::ok);
  EXPECT_EQ(ask([](const Pose&) { return Outcome<Separation>(Separation{.distance = 1e308}); }), Status::ok);
  EXPECT_EQ(ask([](const Pose&) { return Outcome<Response>(Response{}); }), Status::ok) << "a volume may be absent";
  EXPECT_EQ(failures.count(), 0u);
}

TEST_F(Guarded, TurnsExceptionsIntoFailures) {
  EXPECT_EQ(ask([](const Pose&) -> Outcome<bool> { throw std::runtime_error("stack of nodes is full"); }),
            Status::failed);
  EXPECT_EQ(failures.first(), "stack of nodes is full");
  EXPECT_EQ(ask([](const Pose&) -> Outcome<bool> { throw 7; }), Status::failed);
  EXPECT_EQ(failures.first(), "an exception of unknown type was thrown");
  EXPECT_EQ(failures.count(), 1u);
}

TEST_F(Guarded, TellsWantOfMemoryFromOtherFailures) {
  EXPECT_EQ(ask([](const Pose&) -> Outcome<bool> { throw std::bad_alloc(); }), Status::out_of_memory);
  EXPECT_EQ(failures.count(), 1u);
  EXPECT_EQ(failures.count(Status::out_of_memory), 1u);
  EXPECT_EQ(failures.count(Status::failed), 0u);
}

TEST_F(Guarded, CountsConfigurationsByTheirLastStatus) {
  const std::vector<Pose> poses(4);
  std::vector<Status> statuses{Status::crashed, Status::timed_out, Status::ok, Status::crashed};
  std::size_t place = 0;
  failures = {};
  GuardedQuery guarded(
      query,
      [&](const Pose&) { return statuses[place] == Status::ok ? Outcome<bool>(true) : Outcome<bool>(statuses[place]); },
      failures);
  for (place = 0; place < poses.size(); ++place) guarded.ask(poses[place]);
  EXPECT_EQ(failures.count(), 3u);
  EXPECT_EQ(failures.count(Status::crashed), 2u);
  EXPECT_EQ(failures.count(Status::timed_out), 1u);
  statuses[3] = Status::failed;
  place = 3;
  guarded.ask(poses[3]);
  EXPECT_EQ(failures.count(), 3u) << "a configuration counts once";
  EXPECT_EQ(failures.count(Status::crashed), 1u);
}

TEST_F(Guarded, KeepsTheWordsOfAFailure) {
  EXPECT_EQ(ask([this](const Pose& pose) { return query.collide(pose); }), Status::failed);
  EXPECT_EQ(failures.first(), "gave up");
  EXPECT_EQ(ask([this](const Pose& pose) { return query.distance(pose); }), Status::unsupported);
  EXPECT_EQ(failures.first(), "the algorithm gives no such answer");
}

TEST_F(Guarded, RefusesAnswersThatAreNotFinite) {
  for (const double bad : {k_nan, k_infinity, -k_infinity}) {
    EXPECT_EQ(ask([&](const Pose&) { return Outcome<Separation>(Separation{.distance = bad}); }), Status::non_finite);
    EXPECT_EQ(failures.first(), "the answer is not finite");
    for (const auto spoil :
         {+[](Response&r, double x) { r.penalty = x; }, +[](Response&r, double x) { r.force.z() = x; },
          +[](Response&r, double x) { r.torque.x() = x; }, +[](Response&r, double x) { r.reference.y() = x; }}) {
      Response response;
      spoil(response, bad);
      EXPECT_EQ(ask([&](const Pose&) { return Outcome<Response>(response); }), Status::non_finite);
    }
  }
  EXPECT_EQ(ask([](const Pose&) { return Outcome<Response>(Response{.volume = k_infinity}); }), Status::non_finite);
  EXPECT_EQ(failures.count(), 1u);
}

}  // namespace
}  // namespace sixdof::bench
