// Faults of a response must fail the bound that is meant for them. A fault is put into the recorded responses of each
// algorithm of the table; the bound of the measure that the fault names, and no other, is then looked at.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recorded.h"

namespace sixdof {
namespace {

/// A fault, as large as `size` says, in the recording of a scenario.
using Plant = std::function<void(Recording&, const Scenario&, double size)>;

template <class Change>
void change_all(Recording& recording, const Change& change) {
  for (auto* const series : {&recording.forces, &recording.torques}) {
    for (std::size_t k = 0; k < series->size(); ++k) change((*series)[k], k);
  }
}

void scale(Recording& recording, const Scenario&, double factor) {
  change_all(recording, [&](Eigen::Vector3d& v, std::size_t) { v *= factor; });
}

/// A part of each magnitude, in a random direction.
void shake(Recording& recording, const Scenario&, double part) {
  std::mt19937_64 random(20261122);
  std::normal_distribution<double> normal;
  change_all(recording, [&](Eigen::Vector3d& v, std::size_t) {
    v += part * v.norm() * Eigen::Vector3d(normal(random), normal(random), normal(random));
  });
}

/// Every axis becomes the next one.
void turn(Recording& recording, const Scenario&, double) {
  change_all(recording, [](Eigen::Vector3d& v, std::size_t) { v = Eigen::Vector3d(v.z(), v.x(), v.y()); });
}

/// One step in twenty.
void fail_sometimes(Recording& recording, const Scenario&, double) {
  for (std::size_t k = 7; k < recording.size(); k += 20) {
    recording.status[k] = Status::failed;
    recording.forces[k].setZero();
    recording.torques[k].setZero();
  }
}

/// One step in the middle of the path. Magnitudes are compared as parts of the largest one.
void spike(Recording& recording, const Scenario&, double factor) {
  change_all(recording, [&](Eigen::Vector3d& v, std::size_t k) {
    if (2 * k == recording.size()) v *= factor;
  });
}

/// The penalty of one step in the middle of the path.
void spike_penalty(Recording& recording, const Scenario&, double factor) {
  recording.penalties[recording.size() / 2] *= factor;
}

void scale_penalty(Recording& recording, const Scenario&, double factor) {
  for (double& penalty : recording.penalties) penalty *= factor;
}

/// Directions at random, magnitudes as they were.
void scatter(Recording& recording, const Scenario&, double) {
  std::mt19937_64 random(20261127);
  std::normal_distribution<double> normal;
  change_all(recording, [&](Eigen::Vector3d& v, std::size_t) {
    v = v.norm() * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  });
}

/// Of a closed path.
void delay(Recording& recording, const Scenario&, double steps) {
  for (auto* const series : {&recording.forces, &recording.torques}) {
    std::ranges::rotate(*series, series->end() - static_cast<std::ptrdiff_t>(steps));
  }
}

/// Adds a force across the torque, or a torque across the force, where the ideal has none: `size` times the wanted
/// part, over the reference length.
void leak(Recording& recording, const Scenario& scenario, double size) {
  const double length = scenario.description().reference_length;
  for (std::size_t k = 0; k < recording.size(); ++k) {
    Eigen::Vector3d& force = recording.forces[k];
    Eigen::Vector3d& torque = recording.torques[k];
    if (scenario.name() == "III") {
      force += Eigen::Vector3d(size * torque.norm() / length, 0.0, 0.0);
    } else {
      torque += Eigen::Vector3d(0.0, 0.0, size * force.norm() * length);
    }
  }
}

/// A force against the motion, as a part of the force.
void rub(Recording& recording, const Scenario&, double part) {
  const auto& poses = recording.poses;
  for (std::size_t k = 0; k < recording.size(); ++k) {
    const Eigen::Vector3d step = poses[(k + 1) % poses.size()].t - poses[k].t;
    recording.forces[k] -= part * recording.forces[k].norm() * step.normalized();
  }
}

struct Fault {
  const char* name;
  const char* measure;  ///< The one whose bound must catch it; "*" is F, in III T.
  Plant plant;
  double size = 0.0;
  /// Of an algorithm whose own measure is no less than this, the fault is `large`: it has to stand out.
  double own = std::numeric_limits<double>::infinity();
  double large = 0.0;
};

const std::vector<Fault>& faults() {
  static const std::vector<Fault> list{
      {"twice_as_strong", "gain_*", scale, 2.0},
      {"ten_times_too_weak", "gain_*", scale, 0.1},
      {"reversed", "gamma_*_deg", scale, -1.0},
      {"turned", "gamma_*_deg", turn},
      {"silent", "misses", scale, 0.0},
      {"failing_sometimes", "failed", fail_sometimes},
      {"noisy", "noise_*", shake, 0.1, 0.01, 1.5},
      {"spiking", "sigma_*", spike, 100.0},
      {"penalty_spiking", "sigma_q", spike_penalty, 100.0},
      {"penalty_twice_as_large", "gain_q", scale_penalty, 2.0},
      {"scattered", "nu_direction_*", scatter},
      {"late", "lag", delay, 3.0},
      {"leaking", "leakage", leak, 1.0, 0.4, 20.0},
      {"rubbing", "loop_work", rub, 0.5},
  };
  return list;
}

/// An algorithm on a scenario, with one fault.
struct Case {
  const Bound* bound;
  const Fault* fault;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.bound->scenario << ' ' << c.bound->algorithm << ' ' << c.fault->name;
}

/// The measure meant for a fault on a scenario.
std::string measure_of(const Fault& fault, std::string_view scenario) {
  std::string name = fault.measure;
  if (const auto star = name.find('*'); star != std::string::npos) name[star] = scenario == "III" ? 'T' : 'F';
  return name;
}

std::vector<Case> cases() {
  std::vector<Case> list;
  for (const Bound& bound : bounds()) {
    for (const Fault& fault : faults()) {
      if (bound.kind == Kind::weakness || bound.measure != measure_of(fault, bound.scenario)) continue;
      list.push_back({&bound, &fault});
    }
  }
  return list;
}

class FaultyResponse : public ::testing::TestWithParam<Case> {};

TEST_P(FaultyResponse, IsCaughtByTheBoundMeantForIt) {
  const auto& [bound, fault] = GetParam();
  const Recorded& r = recorded(std::string(bound->scenario), std::string(bound->algorithm));
  Recording recording = r.recording;
  const std::optional<double> own = measured(*bound, recording);
  ASSERT_TRUE(own);
  fault->plant(recording, *r.scenario, std::abs(*own) < fault->own ? fault->size : fault->large);
  const std::optional<double> value = measured(*bound, recording);
  ASSERT_TRUE(value) << "undefined with the fault";
  EXPECT_FALSE(holds(*bound, *value)) << bound->measure << " is " << *value << ", was " << *own;
}

INSTANTIATE_TEST_SUITE_P(Gates, FaultyResponse, ::testing::ValuesIn(cases()), [](const auto& made) {
  const Bound& bound = *made.param.bound;
  return test_name(
      {bound.scenario, bound.algorithm, to_string(bound.law), to_string(bound.kind), made.param.fault->name});
});

/// Weaknesses alone leave a fault without a bound: few algorithms, and each fault is caught in most.
TEST(Faults, EachIsPlantedInNearlyAllAlgorithms) {
  for (const Fault& fault : faults()) {
    std::ptrdiff_t weak = 0, held = 0;
    for (const Bound& bound : bounds()) {
      if (bound.measure == measure_of(fault, bound.scenario)) ++(bound.kind == Kind::weakness ? weak : held);
    }
    EXPECT_GE(held, 4 * weak) << fault.name;
  }
}

}  // namespace
}  // namespace sixdof
