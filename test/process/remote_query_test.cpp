#include <sixdof/process/remote_algorithm.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <memory>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sixdof/base/error.h>

#include "deadly_query.h"
#include "script.h"

namespace sixdof {
namespace {

using test::cone;
using test::script;
using test::torus;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Poses near contact, some of them faulty.
std::vector<Pose> poses(std::size_t count) {
  std::mt19937_64 random(7);
  const auto draw = [&] { return 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0; };
  std::vector<Pose> list;
  while (list.size() < count) {
    const Eigen::Quaterniond q = Eigen::Quaterniond(draw(), draw(), draw(), draw()).normalized();
    list.push_back({q.toRotationMatrix(), torus().diagonal() * Eigen::Vector3d(draw(), draw(), draw())});
  }
  return list;
}

RemoteProgram serving(const std::string& algorithm, ProcessLimits limits = {}) {
  return {{SERVING_PROGRAM, algorithm}, limits};
}

std::unique_ptr<RemoteQuery> remote(const std::string& algorithm, ProcessLimits limits = {}) {
  const RemoteProgram program = serving(algorithm, limits);
  const Traits traits = ask_greeting(program).traits;
  return std::make_unique<RemoteQuery>(program, traits, torus(), cone(), Settings(traits.parameters));
}

std::size_t count_faulty(const std::vector<Pose>& list) {
  return static_cast<std::size_t>(std::ranges::count_if(list, test::is_faulty));
}

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

TEST(RemoteQuery, AnswersHaveTheSameBits) {
  const auto there = remote("exact");
  const auto exact = make_exact_algorithm();
  const auto here = exact->prepare(torus(), cone(), exact->settings());
  EXPECT_EQ(there->footprint().bytes, here->footprint().bytes);
  std::size_t colliding = 0;
  for (const Pose& X_AB : poses(200)) {
    EXPECT_EQ(there->collide(X_AB).value, here->collide(X_AB).value);
    const auto far = there->distance(X_AB), near = here->distance(X_AB);
    EXPECT_TRUE(same_bits(far.value.distance, near.value.distance));
    EXPECT_TRUE(same_bits(far.value.witness_a, near.value.witness_a));
    EXPECT_TRUE(same_bits(far.value.witness_b, near.value.witness_b));
    EXPECT_EQ(far.value.triangle_a, near.value.triangle_a);
    const auto push = there->respond(X_AB), pull = here->respond(X_AB);
    EXPECT_EQ(push.status, pull.status);
    EXPECT_TRUE(same_bits(push.value.volume, pull.value.volume));
    EXPECT_TRUE(same_bits(push.value.force, pull.value.force));
    EXPECT_TRUE(same_bits(push.value.torque, pull.value.torque));
    EXPECT_TRUE(same_bits(push.value.reference, pull.value.reference));
    colliding += here->collide(X_AB).value ? 1 : 0;
    EXPECT_GT(there->last_ns(), 0.0);
  }
  EXPECT_GT(colliding, 5u);
  EXPECT_LT(colliding, 195u);
  EXPECT_TRUE(there->is_timed_inside());
}

TEST(RemoteQuery, TakesSettingsAndSaysWhatItIs) {
  const auto greeting = ask_greeting(serving("configured"));
  EXPECT_EQ(greeting.traits.version, "2.5");
  EXPECT_TRUE(greeting.times);
  Settings settings(greeting.traits.parameters);
  settings.set_all({"gap=0.1", "mode=far"});
  RemoteQuery query(serving("configured"), greeting.traits, torus(), torus(), settings);
  EXPECT_EQ(query.distance(Pose()).value.distance, 100.1);
  EXPECT_EQ(query.footprint().counts.at(1), (std::pair<std::string, double>("fill_a", 0.1)));
  EXPECT_EQ(query.work().at(0).tested, 1.0);
  EXPECT_EQ(query.respond(Pose()).status, Status::unsupported);
  EXPECT_EQ(query.collide(Pose()).status, Status::failed);
  EXPECT_EQ(query.diagnosis(), "no convergence");
  EXPECT_GT(query.prepared().wall_ns.value_or(0.0), 0.0);
}

TEST(RemoteQuery, DoesNotAskWhatTheProgramDoesNotAnswer) {
  const auto algorithm = script("exit 3");
  const auto query = algorithm->prepare(torus(), cone(), algorithm->settings());
  EXPECT_EQ(query->respond(Pose()).status, Status::unsupported);
  EXPECT_EQ(query->collide(Pose()).status, Status::crashed);
}

/// Each way to die costs exactly the poses at which it happens.
TEST(RemoteQuery, EveryDeathCostsItsPoseOnly) {
  const std::vector<Pose> list = poses(160);
  const std::size_t faulty = count_faulty(list);
  ASSERT_GT(faulty, 3u);
  const auto exact = make_exact_algorithm();
  const auto here = exact->prepare(torus(), cone(), exact->settings());
  for (const test::Death& death : test::deaths()) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    if (death.status == Status::out_of_memory) continue;  // no limit of memory
#endif
    const auto query = remote(death.name, {.query_s = 2.0, .memory_bytes = std::size_t{400} << 20});
    for (const Pose& X_AB : list) {
      const auto answer = query->distance(X_AB);
      EXPECT_EQ(answer.status, test::is_faulty(X_AB) ? death.status : Status::ok) << death.name << query->diagnosis();
      if (answer.ok()) {
        EXPECT_TRUE(same_bits(answer.value.distance, here->distance(X_AB).value.distance)) << death.name;
      } else {
        EXPECT_FALSE(query->diagnosis().empty()) << death.name;
      }
    }
  }
}

TEST(RemoteQuery, APoseThatEndedAProcessIsNotAskedAgain) {
  const std::vector<Pose> list = poses(40);
  const auto faulty = std::ranges::find_if(list, test::is_faulty);
  ASSERT_NE(faulty, list.end());
  const auto query = remote("abort");
  EXPECT_EQ(query->collide(*faulty).status, Status::crashed);
  EXPECT_EQ(query->diagnosis(), "ended by signal 6 (Aborted)");
  EXPECT_TRUE(query->collide(Pose{.t = {1, 2, 300}}).ok());
  EXPECT_EQ(query->collide(*faulty).status, Status::crashed);
  EXPECT_EQ(query->diagnosis(), "ended by signal 6 (Aborted)");
}

/// The timed loops find the poses that end the process, or give no answer, and time the others.
TEST(RemoteQuery, TimedLoopsLeaveOutWhatEndsTheProcess) {
  const std::vector<Pose> list = poses(160);
  for (const char* const name : {"abort", "endless-loop"}) {
    const Status status = name == std::string("abort") ? Status::crashed : Status::timed_out;
    const auto query = remote(name, {.query_s = 2.0});
    const auto each = query->time_each<Separation>(list, 2);
    EXPECT_EQ(each.failed.size(), count_faulty(list));
    for (const auto& failed : each.failed) {
      EXPECT_TRUE(test::is_faulty(list.at(failed.place)));
      EXPECT_EQ(failed.status, status);
    }
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (test::is_faulty(list[i])) continue;
      EXPECT_GT(each.least_ns.at(i), 0.0);
      EXPECT_LE(each.least_ns.at(i), each.once_ns.at(i));
    }
  }
  const auto query = remote("configured");
  EXPECT_EQ(query->time_each<bool>(list, 1).failed.size(), list.size()) << "exceptions are failures there, too";
  const auto together = query->time_together<Separation>(list, 5);
  EXPECT_GT(together.cpu_ns, 0.0);
  EXPECT_GE(together.wall_ns, 0.2 * together.cpu_ns);
  query->distance(Pose());
  EXPECT_EQ(query->work().at(0).tested, static_cast<double>(5 * list.size() + 1)) << "asked in every pass";
}

TEST(RemoteQuery, LongListsAreAskedInParts) {
  const std::vector<Pose> list(2 * protocol::k_most_poses + 10);
  const auto query = remote("configured");
  EXPECT_EQ(query->time_each<Separation>(list, 1).once_ns.size(), list.size());
  query->distance(Pose());
  EXPECT_EQ(query->work().at(0).tested, static_cast<double>(list.size() + 1));
}

TEST(RemoteQuery, DeathInPrepareIsAnError) {
  const auto words = [](const std::string& algorithm) -> std::string {
    try {
      remote(algorithm);
    } catch (const BadMesh& e) {
      return std::string("BadMesh: ") + e.what();
    } catch (const Error& e) {
      return e.what();
    }
    return "prepared";
  };
  EXPECT_EQ(words("dies-in-prepare"),
            "dies-in-prepare: crashed while it prepared the pair: ended by signal 9 (Killed)");
  EXPECT_EQ(words("refuses"), "BadMesh: torus-1k: too pretty");
}

TEST(Script, SilenceNonsenseAndAClosedPipe) {
  const ProcessLimits short_limit{.query_s = 0.5};
  const auto status_of = [&](const std::string& rest, const std::string& words) {
    const auto query = script(rest, short_limit)->prepare(torus(), torus(), Settings());
    const Status status = query->collide(Pose()).status;
    EXPECT_THAT(query->diagnosis(), HasSubstr(words)) << rest;
    return status;
  };
  EXPECT_EQ(status_of("sleep 600", "gave no answer in time"), Status::timed_out);
  EXPECT_EQ(status_of("echo Hello", R"(wrote a malformed reply: "Hello")"), Status::failed);
  EXPECT_EQ(status_of("echo '{\"distance\": 1}'", "key 'collide' not found"), Status::failed);
  EXPECT_EQ(status_of("exec >&-", "closed its standard streams"), Status::crashed);
  EXPECT_EQ(status_of("exit 3", "ended with exit code 3"), Status::crashed);
  EXPECT_EQ(status_of("kill -9 $$", "ended by signal 9"), Status::crashed);
  EXPECT_EQ(status_of("echo '{\"status\":\"non_finite\",\"words\":\"NaN\"}'", "NaN"), Status::non_finite);
}

TEST(Script, WhatIsNoAnswerIsNeverOne) {
  const auto status_of = [](const std::string& line) {
    const auto query = script("echo '" + line + "'")->prepare(torus(), torus(), Settings());
    return query->distance(Pose()).status;
  };
  EXPECT_EQ(status_of(R"({"distance": 1})"), Status::ok);
  EXPECT_EQ(status_of(R"({"distance": "nan"})"), Status::non_finite);
  EXPECT_EQ(status_of(R"({"distance": "-inf"})"), Status::non_finite);
  EXPECT_EQ(status_of(R"({"distance": 1, "triangle_a": 0.5})"), Status::failed);
  EXPECT_EQ(status_of(R"({"distance": 1, "ns": -3})"), Status::failed);
}

TEST(Script, ATimeThatHasNotPassedIsNonsense) {
  for (const char* const ns : {"1e300", "60e9", "-1"}) {
    const auto query =
        script("echo '{\"collide\": true, \"ns\": " + std::string(ns) + "}'")->prepare(torus(), torus(), Settings());
    EXPECT_EQ(query->collide(Pose()).status, Status::failed) << ns;
    EXPECT_THAT(query->diagnosis(), ::testing::StartsWith("wrote a malformed reply: ")) << ns;
    const auto timed = as_remote(*query)->time_each<bool>(std::vector<Pose>(3), 1);
    EXPECT_EQ(timed.failed.size(), 3u) << ns;
  }
}

TEST(Script, ATimeOfPreparingThatHasNotPassedIsNonsense) {
  const auto words = [](const std::string& times) -> std::string {
    try {
      script("exit", {}, R"({"prepared": true, )" + times + "}")->prepare(torus(), torus(), Settings());
    } catch (const Error& e) {
      return e.what();
    }
    return "prepared";
  };
  EXPECT_EQ(words(R"("ns": 5, "cpu_ns": 5)"), "prepared");
  EXPECT_EQ(words(R"("ns": 1e7)"), "prepared") << "within a tick of a coarse clock";
  for (const char* const times : {R"("ns": 1e300)", R"("ns": 60e9)", R"("ns": -5)", R"("cpu_ns": 1e300)"}) {
    EXPECT_THAT(words(times), HasSubstr("failed while it prepared the pair: wrote a malformed reply: ")) << times;
  }
}

TEST(Script, TimesOfALoopThatHaveNotPassedAreNonsense) {
  const std::vector<Pose> list = poses(2);
  const auto words = [&](const std::string& times) -> std::string {
    const auto query =
        script("echo '" + times + "'", {}, R"({"prepared":true})", R"("time")")->prepare(torus(), torus(), Settings());
    RemoteQuery& there = *as_remote(*query);
    try {
      times.starts_with("{\"wall") ? there.time_together<bool>(list, 3) : there.time_each<bool>(list, 3);
    } catch (const Error& e) {
      return e.what();
    }
    return "timed";
  };
  EXPECT_EQ(words(R"({"once_ns": [9, 9], "least_ns": [8, 9]})"), "timed");
  EXPECT_EQ(words(R"({"once_ns": [9, 1e300], "least_ns": [8, 1e300], "failed": [[1, "failed", ""]]})"), "timed")
      << "no time of a pose without an answer";
  EXPECT_EQ(words(R"({"wall_ns": 9, "cpu_ns": 9})"), "timed");
  for (const char* const times :
       {R"({"once_ns": [9, 60e9], "least_ns": [9, 9]})", R"({"once_ns": [9, 9], "least_ns": [9, 60e9]})",
        R"({"wall_ns": 1e300, "cpu_ns": 9})", R"({"wall_ns": 9, "cpu_ns": 1e300})"}) {
    EXPECT_THAT(words(times), HasSubstr("have passed")) << times;
  }
}

TEST(Script, ALineBetweenTwoRequestsEndsTheProcess) {
  // Two lines for the first question: the second is not the answer to the next one.
  const auto query = script("echo '{\"distance\": 1}'; echo '{\"distance\": 2}'; sleep 0.2", {.query_s = 20.0})
                         ->prepare(torus(), torus(), Settings());
  const std::vector<Pose> list = poses(3);
  EXPECT_EQ(query->distance(list[0]).value.distance, 1.0);
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  EXPECT_EQ(query->distance(list[1]).status, Status::failed);
  EXPECT_THAT(query->diagnosis(), HasSubstr("wrote a line that answers no request"));
  EXPECT_EQ(query->distance(list[2]).value.distance, 1.0) << "of a new process";
}

TEST(Script, WithoutAClockIsTimedFromOutside) {
  const auto query = script("echo '{\"collide\": true}'")->prepare(torus(), torus(), Settings());
  RemoteQuery& there = *as_remote(*query);
  EXPECT_TRUE(there.collide(Pose()).value);
  EXPECT_FALSE(there.is_timed_inside());
  EXPECT_GT(there.last_ns(), 0.0);
  const auto timed = there.time_each<bool>(std::vector<Pose>(5), 2);
  EXPECT_EQ(timed.once_ns.size(), 5u);
  EXPECT_GT(timed.wall_ns, 0.0);
  const auto clocked = script("echo '{\"collide\": true, \"ns\": 250}'")->prepare(torus(), torus(), Settings());
  EXPECT_EQ(as_remote(*clocked)->time_together<bool>(std::vector<Pose>(5), 2).wall_ns, 2500.0);
  EXPECT_TRUE(as_remote(*clocked)->is_timed_inside());
}

TEST(Script, GivesUpAfterTooManyDeathsInARow) {
  const auto query = script("exit 3")->prepare(torus(), torus(), Settings());
  const std::vector<Pose> list = poses(RemoteQuery::k_most_deaths + 10);
  const auto count = [&](Status status) {
    return std::ranges::count_if(list, [&](const Pose& X_AB) { return query->collide(X_AB).status == status; });
  };
  EXPECT_EQ(count(Status::crashed), RemoteQuery::k_most_deaths);
  EXPECT_EQ(count(Status::failed), 10);
  EXPECT_THAT(query->diagnosis(),
              StartsWith("not asked after 20 crashes or timeouts in a row, the last: crashed: ended with"));
  as_remote(*query)->forgive();
  EXPECT_EQ(count(Status::crashed), static_cast<std::ptrdiff_t>(list.size())) << "of another row";
}

TEST(External, IsRefusedUnlessItGreets) {
  const auto words = [](const std::string& command, ProcessLimits limits = {}) -> std::string {
    try {
      RemoteAlgorithm::external("mine", command, limits);
    } catch (const BadArgument& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_EQ(words("false"), "external algorithm mine (false): ended with exit code 1");
  EXPECT_THAT(words("/no/such/program"), HasSubstr("could not be started"));
  EXPECT_THAT(words("echo Hello"), HasSubstr(R"(wrote a malformed reply: "Hello")"));
  EXPECT_THAT(words("echo '{\"protocol\":2,\"name\":\"x\",\"version\":\"1\",\"answers\":[]}'"),
              HasSubstr("not version 1 of the protocol"));
  EXPECT_THAT(words("echo '{\"protocol\":1,\"name\":\"x\",\"version\":\"1\",\"answers\":[]}'"),
              HasSubstr("answers no kind of query"));
  EXPECT_THAT(words("sleep 600", {.prepare_s = 0.3}), HasSubstr("gave no answer in time"));
  EXPECT_EQ(words(std::string(SERVING_PROGRAM) + " exact"), "accepted");
}

}  // namespace
}  // namespace sixdof
