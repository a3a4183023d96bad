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
  std::vector<Eigen::Vector3d> ideal;
  std::vector<Eigen::Vector3d> measured;
};

/// Force and torque over some of the steps.
struct Selection {
  Compared force;
  Compared torque;
  std::size_t failed = 0;

  bool has_force() const { return peak(force.ideal) > 0.0; }
  bool has_torque() const { return peak(torque.ideal) > 0.0; }
};

class Evaluator {
 public:
  Evaluator(const Scenario& scenario, const Recording& recording, IdealLaw law)
      : scenario_(scenario), recording_(recording), ideals_(ideals_of(scenario, recording, law)) {}

  Measures evaluate() {
    std::size_t inside = 0;
    for (const double progress : recording_.progress) inside += scenario_.in_window(progress) ? 1 : 0;
    if (inside > 0) add_all(true, "");
    if (inside < recording_.size()) add_all(false, "_all");
    if (scenario_.closed()) {
      add("loop_work", loop_work(recording_.forces, recording_.torques, recording_.poses, scenario_.reference_b()));
    }
    const Latency times = latency(recording_.times_ns);
    measures_.insert(measures_.end(), {{"mean_ns", times.mean},
                                       {"processor_ns", recording_.processor_ns},
                                       {"p50_ns", times.p50},
                                       {"p99_ns", times.p99},
                                       {"p999_ns", times.p999},
                                       {"max_ns", times.max},
                                       {"over_1ms", times.over_deadline}});
    return std::move(measures_);
  }

 private:
  /// @param window_only steps in the window only; @param answered_only steps with an answer only
  Selection select(bool window_only, bool answered_only) const {
    Selection selection;
    for (std::size_t k = 0; k < recording_.size(); ++k) {
      if (window_only && !scenario_.in_window(recording_.progress[k])) continue;
      const bool answered = recording_.status[k] == Status::ok;
      if (!answered) ++selection.failed;
      if (answered_only && !answered) continue;
      selection.force.ideal.push_back(ideals_[k].force);
      selection.force.measured.push_back(recording_.forces[k]);
      selection.torque.ideal.push_back(ideals_[k].torque);
      selection.torque.measured.push_back(recording_.torques[k]);
    }
    return selection;
  }

  void add(const std::string& name, const std::optional<double>& value) {
    if (value) measures_.emplace_back(name, *value);
  }

  void add_all(bool window_only, const std::string& suffix) {
    const Selection answered = select(window_only, true);
    const Selection every = select(window_only, false);
    if (answered.has_force()) add_compared(answered.force, every.force, "_F", suffix);
    if (answered.has_torque()) add_compared(answered.torque, every.torque, "_T", suffix);

    const bool by_force = answered.has_force() || !answered.has_torque();
    const Compared& main = by_force ? answered.force : answered.torque;
    const DirectionError direction = direction_error(main.ideal, main.measured);
    add("misses" + suffix, static_cast<double>(direction.misses));
    add("false_contacts" + suffix, static_cast<double>(direction.false_contacts));
    add("skipped" + suffix, static_cast<double>(direction.skipped));
    add("failed" + suffix, static_cast<double>(answered.failed));
    const Compared& main_every = by_force ? every.force : every.torque;
    add("lag" + suffix, lag(main_every.ideal, main_every.measured, k_lag_reach));

    if (answered.has_force() && !answered.has_torque()) {
      add("leakage" + suffix,
          leakage(answered.torque.measured, answered.force.measured, 1.0 / scenario_.reference_length()));
    } else if (answered.has_torque() && !answered.has_force()) {
      add("leakage" + suffix, leakage(answered.force.measured, answered.torque.measured, scenario_.reference_length()));
    }
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

  const Scenario& scenario_;
  const Recording& recording_;
  std::vector<IdealWrench> ideals_;
  Measures measures_;
};

/// Intervals that are refined, and how often each is halved: a slope shrinks to a thousandth.
constexpr std::size_t k_jump_candidates = 4;
constexpr std::size_t k_jump_halvings = 10;

}  // namespace

std::vector<IdealWrench> ideals_of(const Scenario& scenario, const Recording& recording, IdealLaw law) {
  std::vector<IdealWrench> ideals;
  ideals.reserve(recording.size());
  for (const double progress : recording.progress) {
    const std::optional<IdealWrench> ideal = scenario.ideal(law, progress);
    if (!ideal) throw BadArgument(fmt::format("scenario {} has no ideal \"{}\"", scenario.name(), to_string(law)));
    ideals.push_back(*ideal);
  }
  return ideals;
}

Measures evaluate(const Scenario& scenario, const Recording& recording, IdealLaw law) {
  return Evaluator(scenario, recording, law).evaluate();
}

Measures evaluate_jumps(const Scenario& scenario, Query& query, const Recording& recording, IdealLaw law) {
  std::vector<Eigen::Vector3d> ideal_forces;
  std::vector<Eigen::Vector3d> ideal_torques;
  for (const IdealWrench& ideal : ideals_of(scenario, recording, law)) {
    ideal_forces.push_back(ideal.force);
    ideal_torques.push_back(ideal.torque);
  }
  Measures measures;
  const auto add = [&](const char* name, Vectors ideal, Vectors measured, Eigen::Vector3d Response::*component) {
    if (peak(ideal) == 0.0 || peak(measured) == 0.0) return;
    const auto at = [&](double progress) -> Eigen::Vector3d {
      std::string diagnosis;
      const Outcome<Response> outcome = respond_at(scenario, query, progress, diagnosis);
      return outcome.ok() ? Eigen::Vector3d(outcome.value.*component) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    };
    const double jump = largest_jump(recording.progress, measured, at, k_jump_candidates, k_jump_halvings);
    measures.emplace_back(name, jump / peak(measured));
  };
  add("jump_F", ideal_forces, recording.forces, &Response::force);
  add("jump_T", ideal_torques, recording.torques, &Response::torque);
  return measures;
}

}  // namespace sixdof
