// Faults of a response must fail the gates that the algorithm passes. A fault is put into the recorded responses of
// each algorithm of the table; at least one of the algorithm's own bounds must then be broken.

#include <functional>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "recorded.h"

namespace sixdof {
namespace {

void scale(Recording& recording, double factor) {
  for (auto* const series : {&recording.forces, &recording.torques}) {
    for (Eigen::Vector3d& v : *series) v *= factor;
  }
}

/// 10 % of each magnitude, in a random direction.
void shake(Recording& recording) {
  std::mt19937_64 random(20261122);
  std::normal_distribution<double> normal;
  for (auto* const series : {&recording.forces, &recording.torques}) {
    for (Eigen::Vector3d& v : *series) {
      v += 0.1 * v.norm() * Eigen::Vector3d(normal(random), normal(random), normal(random));
    }
  }
}

void turn(Recording& recording) {
  constexpr double k_angle = 1.0;  // radian
  const Eigen::AngleAxisd rotation(k_angle, Eigen::Vector3d(0.3, -0.5, 0.8).normalized());
  for (auto* const series : {&recording.forces, &recording.torques}) {
    for (Eigen::Vector3d& v : *series) v = rotation * v;
  }
}

/// One step in twenty.
void fail_sometimes(Recording& recording) {
  for (std::size_t k = 7; k < recording.size(); k += 20) {
    recording.status[k] = Status::failed;
    recording.forces[k].setZero();
    recording.torques[k].setZero();
  }
}

struct Fault {
  const char* name;
  std::function<void(Recording&)> apply;
};

const std::vector<Fault>& faults() {
  static const std::vector<Fault> list{
      {"twice_as_strong", [](Recording& r) { scale(r, 2.0); }},
      {"ten_times_too_weak", [](Recording& r) { scale(r, 0.1); }},
      {"reversed", [](Recording& r) { scale(r, -1.0); }},
      {"silent", [](Recording& r) { scale(r, 0.0); }},
      {"turned", turn},
      {"noisy", shake},
      {"failing_sometimes", fail_sometimes},
  };
  return list;
}

/// An algorithm on a scenario, with one fault.
struct Case {
  std::string scenario, algorithm;
  const Fault* fault;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.scenario << ' ' << c.algorithm << ' ' << c.fault->name; }

std::vector<Case> cases() {
  std::map<std::pair<std::string, std::string>, bool> responds;
  for (const Bound& bound : bounds()) {
    const auto entry = responds.try_emplace({std::string(bound.scenario), std::string(bound.algorithm)}, true).first;
    // An algorithm that is recorded to miss the contact has no response that a fault could change.
    if (bound.measure == "misses" && bound.kind == Kind::records) entry->second = false;
  }
  std::vector<Case> list;
  for (const auto& [subject, any_response] : responds) {
    for (const Fault& fault : faults()) {
      if (any_response) list.push_back({subject.first, subject.second, &fault});
    }
  }
  return list;
}

class FaultyResponse : public ::testing::TestWithParam<Case> {};

TEST_P(FaultyResponse, FailsAGate) {
  const Case& c = GetParam();
  Recording recording = recorded(c.scenario, c.algorithm).recording;
  c.fault->apply(recording);
  std::vector<std::string> broken;
  for (const Bound& bound : bounds()) {
    if (bound.scenario != c.scenario || bound.algorithm != c.algorithm || bound.measure.starts_with("jump")) continue;
    const std::optional<double> value = measured(bound, recording);
    // A measure that is undefined now was defined before: the gate fails.
    const Verdict verdict = value ? judge(std::abs(*value), bound.bound, bound.kind) : Verdict::changed;
    if (verdict == Verdict::worse || verdict == Verdict::changed) broken.emplace_back(bound.measure);
  }
  EXPECT_FALSE(broken.empty());
  RecordProperty("broken", fmt::format("{}", fmt::join(broken, " ")));
}

INSTANTIATE_TEST_SUITE_P(Gates, FaultyResponse, ::testing::ValuesIn(cases()), [](const auto& made) {
  return test_name({made.param.scenario, made.param.algorithm, made.param.fault->name});
});

}  // namespace
}  // namespace sixdof
