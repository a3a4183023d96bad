#include "bench/harness/depth_truth.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "bench/harness/stored_truths.h"

namespace sixdof::bench {
namespace {

constexpr const char* k_kind = "depth-truth";
/// To be raised where DepthOracle or what is stored changes.
constexpr int k_version = 3;
/// What is asked of the quadrature: half of what is judged.
constexpr DepthTolerance k_tolerance{.relative = 0.5 * DepthTruth::k_judged_error, .most_pieces = 200'000};
/// Force, torque, reference, depth.
constexpr std::size_t k_numbers = 10;

std::optional<std::vector<DepthTruth>> load(const std::string& key, std::size_t count) {
  const std::optional<StoredTruths> stored = load_truths(k_kind, key, count, k_numbers);
  if (!stored) return std::nullopt;
  std::vector<DepthTruth> truths(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double* const numbers = &stored->numbers[k_numbers * i];
    const auto vector = [&](std::size_t k) { return Eigen::Vector3d(numbers + 3 * k); };
    truths[i] = {.response = {.penalty = numbers[9], .force = vector(0), .torque = vector(1), .reference = vector(2)},
                 .force_judged = (stored->flags[i] & 1u) != 0,
                 .torque_judged = (stored->flags[i] & 2u) != 0};
  }
  return truths;
}

void store(const std::string& key, std::span<const DepthTruth> truths) {
  StoredTruths stored;
  for (const DepthTruth& truth : truths) {
    const Response& response = truth.response;
    for (const Eigen::Vector3d* v : {&response.force, &response.torque, &response.reference}) {
      stored.numbers.insert(stored.numbers.end(), v->data(), v->data() + 3);
    }
    stored.numbers.push_back(response.penalty);
    stored.flags.push_back((truth.force_judged ? 1u : 0u) | (truth.torque_judged ? 2u : 0u));
  }
  store_truths(k_kind, key, std::move(stored));
}

}  // namespace

DepthTruth DepthTruths::compute(const Pose& X_AB, DepthDirection direction) {
  if (!oracle_) oracle_ = std::make_unique<const DepthOracle>(*a_, *b_);
  const DepthIntegral found = oracle_->evaluate(X_AB, direction, k_tolerance);
  const auto is_known = [&](double error, const Eigen::Vector3d& vector) {
    return found.converged && error <= DepthTruth::k_judged_error * vector.norm();
  };
  return {
      .response = {.penalty = found.depth, .force = found.force, .torque = found.torque, .reference = found.reference},
      .force_judged = is_known(found.force_error, found.force),
      .torque_judged = is_known(found.torque_error, found.torque)};
}

std::span<const DepthTruth> DepthTruths::at(std::span<const Pose> poses, ResponseLaw law) {
  poses = poses.first(std::min(poses.size(), k_most));
  const DepthDirection direction = law == ResponseLaw::way_out ? DepthDirection::way_out : DepthDirection::normal_of_b;
  const std::string key =
      fmt::format("version {}, {}, tolerance {}, pieces {}, A {}, B {}, {} poses {}", k_version,
                  direction == DepthDirection::way_out ? "way out" : "normals of B", k_tolerance.relative,
                  k_tolerance.most_pieces, a_->hash(), b_->hash(), poses.size(), hash_of(poses));
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  std::optional<std::vector<DepthTruth>> truths = load(key, poses.size());
  if (!truths) {
    truths.emplace();
    for (const Pose& pose : poses) truths->push_back(compute(pose, direction));
    store(key, *truths);
  }
  return known_.emplace(key, *std::move(truths)).first->second;
}

}  // namespace sixdof::bench
