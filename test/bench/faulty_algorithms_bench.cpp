// sixdof-bench with algorithms that answer as `exact` does but have a fault at one pose in 20 (faulty_pose.h), or at
// all.

#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/query/registrar.h>

#include "faulty_pose.h"

namespace {

using namespace sixdof;

void spend_fault_delay() {
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double, std::nano> delay(test::k_fault_delay_ns);
  for (const auto start = Clock::now(); Clock::now() - start < delay;) {
  }
}

/// What an algorithm does at a faulty pose to its right answer, by kind of query; it may throw instead.
struct Fault {
  std::string name;
  bool at_every_pose = false;  ///< Without the delay of a faulty pose.
  Body body = Body::mesh;
  std::unique_ptr<Algorithm> (*base)() = make_exact_algorithm;  ///< Whose answers are right by its law.
  std::function<bool(bool)> collide = [](bool answer) { return answer; };
  std::function<double(double)> distance = [](double answer) { return answer; };
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> force = [](const Eigen::Vector3d& answer) { return answer; };
};

class FaultyQuery final : public Query {
 public:
  FaultyQuery(std::unique_ptr<Query> exact, const Fault& fault) : exact_(std::move(exact)), fault_(fault) {}

  Outcome<bool> collide(const Pose& X_AB) override {
    Outcome<bool> answer = exact_->collide(X_AB);
    if (goes_wrong(X_AB)) answer.value = fault_.collide(answer.value);
    return answer;
  }
  Outcome<Separation> distance(const Pose& X_AB) override {
    Outcome<Separation> answer = exact_->distance(X_AB);
    if (goes_wrong(X_AB)) answer.value.distance = fault_.distance(answer.value.distance);
    return answer;
  }
  Outcome<Response> respond(const Pose& X_AB) override {
    Outcome<Response> answer = exact_->respond(X_AB);
    if (goes_wrong(X_AB)) answer.value.force = fault_.force(answer.value.force);
    return answer;
  }

 private:
  bool goes_wrong(const Pose& X_AB) const {
    if (fault_.at_every_pose) return true;
    if (!test::is_faulty(X_AB)) return false;
    spend_fault_delay();
    return true;
  }

  std::unique_ptr<Query> exact_;
  const Fault& fault_;
};

class FaultyAlgorithm final : public Algorithm {
 public:
  explicit FaultyAlgorithm(Fault fault) : fault_(std::move(fault)) {
    traits_ = {.name = fault_.name,
               .version = "1",
               .summary = "goes wrong at one pose in 20",
               .answers = {.collide = true, .distance = true, .respond = true},
               .law = fault_.base()->traits().law,
               .body = fault_.body};
  }
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings&) const override {
    if (fault_.name == "null-pointer") return nullptr;
    const auto exact = fault_.base();
    return std::make_unique<FaultyQuery>(exact->prepare(a, b, exact->settings()), fault_);
  }

 private:
  Fault fault_;
  Traits traits_;
};

template <class Thrown>
Fault throws(const char* name, Thrown thrown) {
  return {.name = name,
          .collide = [thrown](bool) -> bool { throw thrown; },
          .distance = [thrown](double) -> double { throw thrown; },
          .force = [thrown](const Eigen::Vector3d&) -> Eigen::Vector3d { throw thrown; }};
}

Fault returns(const char* name, double value) {
  return {.name = name,
          .distance = [value](double) { return value; },
          .force = [value](const Eigen::Vector3d& f) { return Eigen::Vector3d(f.x(), value, f.z()); }};
}

Registrar add(Fault fault) {
  return Registrar([fault = std::move(fault)] { return std::make_unique<FaultyAlgorithm>(fault); });
}

const Registrar k_faults[] = {
    add(throws("throws-exception", std::runtime_error("stack of nodes is full"))),
    add(throws("throws-int", 7)),
    add(returns("returns-nan", std::numeric_limits<double>::quiet_NaN())),
    add(returns("returns-infinity", std::numeric_limits<double>::infinity())),
    add(returns("returns-1e308", 1e308)),
    add({.name = "wrong",
         .collide = [](bool answer) { return !answer; },
         .distance = [](double answer) { return 1.1 * answer; }}),
    add({.name = "null-pointer"}),
    add({.name = "zero-force",
         .at_every_pose = true,
         .force = [](const Eigen::Vector3d&) -> Eigen::Vector3d { return Eigen::Vector3d::Zero(); }}),
    add({.name = "turned-depth",
         .at_every_pose = true,
         .base = make_exact_depth_algorithm,
         .force = [](const Eigen::Vector3d& f) { return Eigen::Vector3d(-f.y(), f.x(), f.z()); }}),
    add({.name = "always-apart", .at_every_pose = true, .collide = [](bool) { return false; }}),
    add({.name = "hulls-apart",
         .at_every_pose = true,
         .body = Body::convex_hull,
         .collide = [](bool) { return false; }}),
};

}  // namespace
