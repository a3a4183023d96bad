#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include <sixdof/scenario/scenario.h>

namespace sixdof::test {

/// A query that answers with a scenario's own ideal at the progress that belongs to the pose: a perfect algorithm.
/// `spoil` may then change the answer; it also receives the number of the query, from 0.
class IdealQuery final : public Query {
 public:
  using Spoil = std::function<void(Response& response, double progress, std::size_t number)>;

  /// @param late fraction of the path by which the answer is late
  IdealQuery(const Scenario& scenario, IdealLaw law, Spoil spoil = {}, double late = 0.0)
      : scenario_(scenario), law_(law), spoil_(std::move(spoil)), late_(late) {}

  Outcome<Response> respond(const Pose& X_AB) override {
    const double progress = progress_of(X_AB);
    double answered = progress - late_;
    if (scenario_.description().closed) answered -= std::floor(answered);
    const auto ideal = scenario_.ideal(law_, std::max(0.0, answered));
    Response response;
    response.penalty = ideal->penalty;
    response.force = ideal->force;
    response.torque = ideal->torque;
    response.reference = X_AB * scenario_.description().reference_b;
    if (spoil_) spoil_(response, progress, number_);
    ++number_;
    return response;
  }

 private:
  static constexpr double k_full_angle = 6.283185307179586;

  /// Of a pose on the path, from the one coordinate that changes monotonically along it.
  double progress_of(const Pose& X_AB) const {
    const auto coordinate = [&](const Pose& pose) {
      if (scenario_.description().closed) {
        const double angle = std::atan2(pose.t.y(), pose.t.x());
        return angle < 0.0 ? angle + k_full_angle : angle;
      }
      return scenario_.name() == "III" ? -std::atan2(pose.R(1, 0), pose.R(0, 0)) : pose.t.x();
    };
    if (scenario_.description().closed) return coordinate(X_AB) / k_full_angle;
    const double from = coordinate(scenario_.pose(0.0));
    const double to = coordinate(scenario_.pose(1.0));
    return std::clamp((coordinate(X_AB) - from) / (to - from), 0.0, 1.0);
  }

  const Scenario& scenario_;
  IdealLaw law_;
  Spoil spoil_;
  double late_;
  std::size_t number_ = 0;
};

}  // namespace sixdof::test
