#include <sixdof/scenario/evaluation.h>

#include <algorithm>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/measure/direction.h>
#include <sixdof/measure/latency.h>
#include <sixdof/measure/magnitude.h>
#include <sixdof/measure/path.h>
#include <sixdof/measure/spectrum.h>

namespace sixdof {
namespace {

/// Ideal and measured vectors side by side.
struct Compared {
  std::vector<Eigen::Vector3d> ideal, measured;
};

/// Over some of the steps.
struct Selection {
  Compared force, torque;
  std::size_t failed = 0;
};

struct Evaluator {
  const Scenario& scenario;
  const Recording& recording;
  Ideals ideals;
  Measures measures = {};

  Measures evaluate() {
    std::size_t inside = 0;
    for (const double progress : recording.progress) inside += scenario.in_window(progress) ? 1 : 0;
    if (inside > 0) add_all(true, "");
    if (inside < recording.size()) add_all(false, "_all");
    if (scenario.closed()) {
      add("loop_work", loop_work(recording.forces, recording.torques, recording.poses, scenario.reference_b()));
    }
    const Latency times = latency(recording.times_ns);
    measures.insert(measures.end(), {{"mean_ns", times.mean},
                                     {"processor_ns", recording.processor_ns},
                                     {"p50_ns", times.p50},
                                     {"p99_ns", times.p99},
                                     {"p999_ns", times.p999},
                                     {"max_ns", times.max},
                                     {"over_1ms", times.over_deadline}});
    return std::move(measures);
  }

  /// @param window_only steps in the window only; @param answered_only steps with an answer only
  Selection select(bool window_only, bool answered_only) const {
    Selection selection;
    for (std::size_t k = 0; k < recording.size(); ++k) {
      if (window_only && !scenario.in_window(recording.progress[k])) continue;
      const bool answered = recording.status[k] == Status::ok;
      if (!answered) ++selection.failed;
      if (answered_only && !answered) continue;
      selection.force.ideal.push_back(ideals.forces[k]);
      selection.force.measured.push_back(recording.forces[k]);
      selection.torque.ideal.push_back(ideals.torques[k]);
      selection.torque.measured.push_back(recording.torques[k]);
    }
    return selection;
  }

  void add(const std::string& name, const std::optional<double>& value) {
    if (value) measures.emplace_back(name, *value);
  }

  void add_all(bool window_only, const std::string& suffix) {
    const Selection answered = select(window_only, true);
    const Selection every = select(window_only, false);
    const bool has_force = peak(answered.force.ideal) > 0.0;
    const bool has_torque = peak(answered.torque.ideal) > 0.0;
    if (has_force) add_compared(answered.force, every.force, "_F", suffix);
    if (has_torque) add_compared(answered.torque, every.torque, "_T", suffix);

    Compared Selection::*const wanted = has_force || !has_torque ? &Selection::force : &Selection::torque;
    const DirectionError direction = direction_error((answered.*wanted).ideal, (answered.*wanted).measured);
    add("misses" + suffix, static_cast<double>(direction.misses));
    add("false_contacts" + suffix, static_cast<double>(direction.false_contacts));
    add("skipped" + suffix, static_cast<double>(direction.skipped));
    add("failed" + suffix, static_cast<double>(answered.failed));
    add("lag" + suffix, lag((every.*wanted).ideal, (every.*wanted).measured, k_lag_reach));
    if (has_force == has_torque) return;
    const double length = scenario.reference_length();
    add("leakage" + suffix, has_force ? leakage(answered.torque.measured, answered.force.measured, 1.0 / length)
                                      : leakage(answered.force.measured, answered.torque.measured, length));
  }

  void add_compared(const Compared& answered, const Compared& every, const std::string& which,
                    const std::string& suffix) {
    const auto name = [&](const char* stem, const char* unit = "") { return stem + which + unit + suffix; };
    add(name("sigma"), sigma(answered.ideal, answered.measured));
    add(name("sigma_paper"), sigma_paper(answered.ideal, answered.measured));
    if (const auto fit = fit_gain(answered.ideal, answered.measured)) {
      add(name("gain"), fit->gain);
      add(name("sigma_gain"), fit->sigma);
    }
    const DirectionError direction = direction_error(answered.ideal, answered.measured);
    if (direction.gamma_degrees) {
      add(name("gamma", "_deg"), direction.gamma_degrees);
      add(name("gamma_max", "_deg"), direction.largest_degrees);
    }
    add(name("nu"), nu(every.ideal, every.measured));
    add(name("noise"), residual_noise(every.ideal, every.measured, k_haptic_rate_hz, k_noise_cutoff_hz));
  }
};

}  // namespace

Ideals::Ideals(const Scenario& scenario, const Recording& recording, IdealLaw law) {
  for (const double progress : recording.progress) {
    const std::optional<IdealWrench> ideal = scenario.ideal(law, progress);
    if (!ideal) throw BadArgument(fmt::format("scenario {} has no ideal \"{}\"", scenario.name(), to_string(law)));
    forces.push_back(ideal->force);
    torques.push_back(ideal->torque);
    penalties.push_back(ideal->penalty);
  }
}

Measures evaluate(const Scenario& scenario, const Recording& recording, IdealLaw law) {
  return Evaluator{scenario, recording, Ideals(scenario, recording, law)}.evaluate();
}

Measures evaluate_jumps(const Scenario& scenario, Query& query, const Recording& recording, IdealLaw law) {
  const Ideals ideals(scenario, recording, law);
  // Intervals that are refined, and how often each is halved: a slope shrinks to a thousandth.
  constexpr std::size_t k_candidates = 4;
  constexpr std::size_t k_halvings = 10;
  Measures measures;
  const auto add = [&](const char* name, Vectors ideal, Vectors measured, Eigen::Vector3d Response::*component) {
    if (peak(ideal) == 0.0 || peak(measured) == 0.0) return;
    const auto at = [&](double progress) -> Eigen::Vector3d {
      std::string diagnosis;
      const Outcome<Response> outcome = respond_at(scenario, query, progress, diagnosis);
      return outcome.ok() ? Eigen::Vector3d(outcome.value.*component) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    };
    const double jump = largest_jump(recording.progress, measured, at, k_candidates, k_halvings);
    measures.emplace_back(name, jump / peak(measured));
  };
  add("jump_F", ideals.forces, recording.forces, &Response::force);
  add("jump_T", ideals.torques, recording.torques, &Response::torque);
  return measures;
}

}  // namespace sixdof
