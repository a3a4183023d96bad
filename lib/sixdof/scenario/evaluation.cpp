#include <sixdof/scenario/evaluation.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/measure/direction.h>
#include <sixdof/measure/latency.h>
#include <sixdof/measure/magnitude.h>
#include <sixdof/measure/path.h>
#include <sixdof/measure/spectrum.h>
#include <sixdof/process/remote_algorithm.h>
#include <sixdof/query/ask.h>

namespace sixdof {
namespace {

/// The query alone; exceptions and values that are not finite become a status.
Outcome<Response> respond_guarded(Query& query, const Pose& X_AB, std::string& diagnosis) {
  const auto failed = [&](std::string words) { diagnosis = std::move(words); };
  const auto ask = [&] {
    Outcome<Response> outcome = query.respond(X_AB);
    examine(query, outcome, failed);
    return outcome;
  };
  return ask_guarded(ask, failed);
}

/// Ideal and measured vectors side by side.
struct Compared {
  std::vector<Eigen::Vector3d> ideal, measured;
};

/// Over some of the steps.
struct Selection {
  Compared force, torque;
  std::vector<double> ideal_penalties, penalties;
  std::size_t failed = 0;
  std::map<Status, std::size_t> counted;  ///< Those of k_counted_statuses among them.
};

/// Which parts of an ideal wrench are not zero.
struct Parts {
  bool force, torque;
};

/// A force (or torque) that is below 1e-9 of the torque (force) at the reference length is zero: in Ib rounding leaves
/// 1e-16, and no scenario has a part that small.
Parts parts_of(const Scenario& scenario, Vectors forces, Vectors torques) {
  constexpr double k_rounding = 1e-9;
  const double force = scenario.description().reference_length * peak(forces), torque = peak(torques);
  return {force > k_rounding * torque, torque > k_rounding * force};
}

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
    if (scenario.description().closed) {
      add("loop_work",
          loop_work(recording.forces, recording.torques, recording.poses, scenario.description().reference_b));
    }
    const Latency times = latency(recording.times_ns);
    add("mean_ns", times.mean);
    add("processor_ns", recording.processor_ns);
    add("p50_ns", times.p50);
    add("p99_ns", times.p99);
    add("p999_ns", times.p999);
    add("max_ns", times.max);
    add("over_1ms", times.over_deadline);
    return std::move(measures);
  }

  /// @param window_only steps in the window only; @param answered_only steps with an answer only
  Selection select(bool window_only, bool answered_only) const {
    Selection selection;
    for (std::size_t k = 0; k < recording.size(); ++k) {
      if (window_only && !scenario.in_window(recording.progress[k])) continue;
      const bool answered = recording.status[k] == Status::ok;
      if (!answered) ++selection.failed;
      if (std::ranges::find(k_counted_statuses, recording.status[k]) != k_counted_statuses.end()) {
        ++selection.counted[recording.status[k]];
      }
      if (answered_only && !answered) continue;
      selection.force.ideal.push_back(ideals.forces[k]);
      selection.force.measured.push_back(recording.forces[k]);
      selection.torque.ideal.push_back(ideals.torques[k]);
      selection.torque.measured.push_back(recording.torques[k]);
      // The depth that the paper prints for III is negative: its size counts, as that of its torque does.
      selection.ideal_penalties.push_back(std::abs(ideals.penalties[k]));
      selection.penalties.push_back(recording.penalties[k]);
    }
    return selection;
  }

  void add(const std::string& name, const std::optional<double>& value) {
    if (value) measures.emplace_back(name, *value);
  }

  void add_all(bool window_only, const std::string& suffix) {
    const Selection answered = select(window_only, true);
    const Selection every = select(window_only, false);
    const auto [has_force, has_torque] = parts_of(scenario, answered.force.ideal, answered.torque.ideal);
    if (has_force) add_compared(answered.force, every.force, "_F", suffix);
    if (has_torque) add_compared(answered.torque, every.torque, "_T", suffix);
    if (peak(answered.ideal_penalties) > 0.0) add_penalties(answered, every, suffix);

    Compared Selection::*const wanted = has_force || !has_torque ? &Selection::force : &Selection::torque;
    const DirectionError direction = direction_error((answered.*wanted).ideal, (answered.*wanted).measured);
    add("misses" + suffix, static_cast<double>(direction.misses));
    add("false_contacts" + suffix, static_cast<double>(direction.false_contacts));
    add("skipped" + suffix, static_cast<double>(direction.skipped));
    add("failed" + suffix, static_cast<double>(answered.failed));
    for (const auto& [status, count] : answered.counted) {
      add(std::string(to_string(status)) + suffix, static_cast<double>(count));
    }
    add("lag" + suffix, lag((every.*wanted).ideal, (every.*wanted).measured, k_lag_reach));
    if (has_force == has_torque) return;
    const double length = scenario.description().reference_length;
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
    add(name("nu_direction"), nu_direction(every.ideal, every.measured, k_haptic_rate_hz, k_noise_cutoff_hz));
    add(name("noise"), residual_noise(every.ideal, every.measured, k_haptic_rate_hz, k_noise_cutoff_hz));
  }

  void add_penalties(const Selection& answered, const Selection& every, const std::string& suffix) {
    add("sigma_q" + suffix, sigma(answered.ideal_penalties, answered.penalties));
    if (const auto fit = fit_gain(answered.ideal_penalties, answered.penalties)) {
      add("gain_q" + suffix, fit->gain);
      add("sigma_gain_q" + suffix, fit->sigma);
    }
    add("nu_q" + suffix, nu(every.ideal_penalties, every.penalties));
  }
};

constexpr const char* k_format = "sixdof-series";
constexpr std::uint64_t k_format_version = 1;
constexpr std::size_t k_chunk_rows = 1024;
constexpr std::size_t k_spectrum_hop = 8;

void write_rows(hdf5::File& file, const std::string& name, const std::vector<double>& values, std::size_t columns) {
  file.write_matrix(name, values.data(), values.size() / columns, columns, k_chunk_rows);
}

void write_vectors(hdf5::File& file, const std::string& name, Vectors vectors) {
  file.write_matrix(name, vectors.front().data(), vectors.size(), 3, k_chunk_rows);
}

/// Of the forces or of the torques: signal and residual of the magnitudes, signals of the components.
void write_spectra(hdf5::File& file, const std::string& kind, Vectors ideal, Vectors measured) {
  const std::vector<double> signal = magnitudes(measured);
  std::vector<double> residual = signal;
  if (const auto fit = fit_gain(ideal, measured)) {
    for (std::size_t k = 0; k < residual.size(); ++k) residual[k] -= fit->gain * ideal[k].norm();
  }
  const auto write = [&](const std::string& what, const std::vector<double>& values) {
    const Spectrogram diagram = short_time_spectrum(values, k_haptic_rate_hz, k_spectrum_window, k_spectrum_hop);
    write_rows(file, "/spectrum/" + kind + "_" + what, diagram.intensity, diagram.frequencies.size());
    return diagram;
  };
  write("signal", signal);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> component;
    for (const Eigen::Vector3d& v : measured) component.push_back(v[axis]);
    write(fmt::format("{}_signal", "xyz"[axis]), component);
  }
  const Spectrogram axes = write("residual", residual);
  if (kind != "force") return;  // both kinds have the same axes
  write_rows(file, "/spectrum/times", axes.times, 1);
  write_rows(file, "/spectrum/frequencies", axes.frequencies, 1);
}

}  // namespace

Outcome<Response> respond_at(const Scenario& scenario, Query& query, double progress, std::string& diagnosis) {
  const Pose X_AB = scenario.pose(progress);
  Outcome<Response> outcome = respond_guarded(query, X_AB, diagnosis);
  if (outcome.ok()) outcome.value = outcome.value.about(X_AB * scenario.description().reference_b);
  return outcome;
}

Recording record(const Scenario& scenario, Query& query, std::size_t count) {
  Recording recording;
  recording.progress = scenario.steps(count);
  for (const double progress : recording.progress) recording.poses.push_back(scenario.pose(progress));
  std::string diagnosis;
  respond_guarded(query, recording.poses.front(), diagnosis);
  RemoteQuery* const remote = as_remote(query);
  std::vector<Pose> answered;
  const std::clock_t processor_start = std::clock();
  for (const Pose& X_AB : recording.poses) {
    const auto start = std::chrono::steady_clock::now();
    Outcome<Response> outcome = respond_guarded(query, X_AB, diagnosis);
    const auto stop = std::chrono::steady_clock::now();
    Response response;
    if (outcome.ok()) {
      response = outcome.value.about(X_AB * scenario.description().reference_b);
      answered.push_back(X_AB);
    } else if (recording.first_failure.empty()) {
      recording.first_failure = fmt::format("{}: {}", to_string(outcome.status), diagnosis);
    }
    recording.status.push_back(outcome.status);
    recording.forces.push_back(response.force);
    recording.torques.push_back(response.torque);
    recording.penalties.push_back(response.penalty);
    recording.times_ns.push_back(remote != nullptr ? remote->last_ns()
                                                   : std::chrono::duration<double, std::nano>(stop - start).count());
  }
  if (remote != nullptr) {
    recording.processor_ns =
        answered.empty() ? 0.0
                         : remote->time_together<Response>(answered, 1).cpu_ns / static_cast<double>(answered.size());
    return recording;
  }
  const double processor_s = static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
  recording.processor_ns = processor_s * 1e9 / static_cast<double>(count);
  return recording;
}

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
  const auto add = [&](const char* name, bool is_ideal, Vectors measured, Eigen::Vector3d Response::*component) {
    if (!is_ideal || peak(measured) == 0.0) return;
    const auto at = [&](double progress) -> Eigen::Vector3d {
      std::string diagnosis;
      const Outcome<Response> outcome = respond_at(scenario, query, progress, diagnosis);
      return outcome.ok() ? Eigen::Vector3d(outcome.value.*component) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    };
    const double jump = largest_jump(recording.progress, measured, at, k_candidates, k_halvings);
    measures.emplace_back(name, jump / peak(measured));
  };
  const auto [has_force, has_torque] = parts_of(scenario, ideals.forces, ideals.torques);
  add("jump_F", has_force, recording.forces, &Response::force);
  add("jump_T", has_torque, recording.torques, &Response::torque);
  return measures;
}

void write_series(const std::filesystem::path& path, const Scenario& scenario, const Recording& recording, IdealLaw law,
                  const SeriesSource& source, const Measures& measures) {
  const Ideals ideals(scenario, recording, law);
  std::vector<double> poses;
  for (const Pose& pose : recording.poses) {
    const Eigen::Vector4d q = pose.quaternion();
    poses.insert(poses.end(), {q[0], q[1], q[2], q[3], pose.t.x(), pose.t.y(), pose.t.z()});
  }
  std::vector<std::int32_t> status;
  for (const Status s : recording.status) status.push_back(static_cast<std::int32_t>(s));

  AtomicFile output(path);
  const hdf5::Session session;
  hdf5::File file = hdf5::File::create(output);
  file.write_attribute("/", "format", std::string(k_format));
  file.write_attribute("/", "format_version", k_format_version);
  file.write_attribute("/", "scenario", scenario.name());
  file.write_attribute("/", "law", std::string(to_string(law)));
  file.write_attribute("/", "algorithm", source.algorithm);
  file.write_attribute("/", "version", source.version);
  file.write_attribute("/", "settings", source.settings);
  file.write_attribute("/", "shape", source.shape);
  if (!source.command.empty()) file.write_attribute("/", "command", source.command);
  file.write_attribute("/", "rate_hz", k_haptic_rate_hz);
  file.write_attribute("/", "reference_length", scenario.description().reference_length);
  for (const auto& [name, value] : measures) file.write_attribute("/", name.c_str(), value);
  write_rows(file, "/progress", recording.progress, 1);
  write_rows(file, "/pose", poses, 7);
  write_vectors(file, "/force", recording.forces);
  write_vectors(file, "/torque", recording.torques);
  write_rows(file, "/penalty", recording.penalties, 1);
  write_rows(file, "/time_ns", recording.times_ns, 1);
  write_vectors(file, "/ideal_force", ideals.forces);
  write_vectors(file, "/ideal_torque", ideals.torques);
  write_rows(file, "/ideal_penalty", ideals.penalties, 1);
  file.write_values("/status", std::span<const std::int32_t>(status));
  if (recording.size() >= k_spectrum_window) {
    file.make_group("/spectrum");
    write_spectra(file, "force", ideals.forces, recording.forces);
    write_spectra(file, "torque", ideals.torques, recording.torques);
  }
  file.close();
  output.commit();
}

}  // namespace sixdof
