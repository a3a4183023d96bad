#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include <sixdof/scenario/scenario.h>

namespace sixdof::test {

/// A query that answers with a scenario's own ideal, found by the pose: what a perfect algorithm would do. `spoil` may
/// then change the answer; it also gets the number of the query, from 0.
class IdealQuery final : public Query {
 public:
  using Spoil = std::function<void(Response& response, double progress, std::size_t number)>;

  /// @param late stamps of 1 / `stamps` of the path that the answer comes late
  IdealQuery(const Scenario& scenario, IdealLaw law, Spoil spoil = {}, double late = 0.0)
      : scenario_(scenario), law_(law), spoil_(std::move(spoil)), late_(late) {}

  Outcome<Response> respond(const Pose& X_AB) override {
    const double progress = progress_of(X_AB);
    double shown = progress - late_;
    if (scenario_.closed()) shown -= std::floor(shown);
    const auto ideal = scenario_.ideal(law_, std::max(0.0, shown));
    Response response;
    response.penalty = ideal->penalty;
    response.force = ideal->force;
    response.torque = ideal->torque;
    response.reference = X_AB * scenario_.reference_b();
    if (spoil_) spoil_(response, progress, number_);
    ++number_;
    return response;
  }

 private:
  /// The pose is one of the path's; each path is told apart by one number of it.
  double progress_of(const Pose& X_AB) const {
    const auto coordinate = [&](const Pose& pose) {
      constexpr double k_turn = 6.283185307179586;
      if (scenario_.closed()) {
        const double angle = std::atan2(pose.t.y(), pose.t.x());
        return angle < 0.0 ? angle + k_turn : angle;
      }
      return scenario_.name() == "III" ? -std::atan2(pose.R(1, 0), pose.R(0, 0)) : pose.t.x();
    };
    if (scenario_.closed()) return coordinate(X_AB) / 6.283185307179586;
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
