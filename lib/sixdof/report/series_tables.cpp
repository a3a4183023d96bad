#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Core>

#include <sixdof/measure/direction.h>
#include <sixdof/report/tables.h>

namespace sixdof::report {
namespace {

/// Intensities further below the loudest than this are drawn alike.
constexpr double k_floor_db = -100.0;

/// Of the pieces in the file, which overlap by seven eighths, every fourth is drawn: they still overlap by half.
constexpr std::size_t k_pieces_apart = 4;

using Vector = std::array<double, 3>;

double length(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }

double largest(const Series::Vectors& vectors) {
  double result = 0.0;
  for (const Vector& v : vectors) result = std::max(result, length(v));
  return result;
}

struct Signal {
  std::string name;
  std::vector<double> measured, ideal;  ///< `ideal` is empty where there is none to show.
};

/// Each over the largest magnitude of its own series, as the paper compares them. Zero where that is zero.
Signal component(const std::string& name, const Series::Vectors& measured, const Series::Vectors& ideal, auto part) {
  Signal signal{.name = name, .measured = {}, .ideal = {}};
  const double m = largest(measured), i = largest(ideal);
  for (std::size_t k = 0; k < measured.size(); ++k) {
    signal.measured.push_back(m > 0.0 ? part(measured[k]) / m : 0.0);
    signal.ideal.push_back(i > 0.0 ? part(ideal[k]) / i : 0.0);
  }
  return signal;
}

Signal angle(const std::string& name, const Series::Vectors& measured, const Series::Vectors& ideal) {
  Signal signal{.name = name, .measured = {}, .ideal = {}};
  const double m = k_zero_fraction * largest(measured), i = k_zero_fraction * largest(ideal);
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const bool is_defined = length(measured[k]) > m && length(ideal[k]) > i;
    signal.measured.push_back(is_defined
                                  ? angle_degrees(Eigen::Vector3d(ideal[k].data()), Eigen::Vector3d(measured[k].data()))
                                  : std::nan(""));
  }
  return signal;
}

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

/// Each over the largest value of its own series.
Signal penalty(const Series& series) {
  Signal signal{.name = "penalty", .measured = series.penalty, .ideal = series.ideal_penalty};
  for (std::vector<double>* const values : {&signal.measured, &signal.ideal}) {
    const double scale = largest(*values);
    if (scale > 0.0) std::ranges::for_each(*values, [scale](double& value) { value /= scale; });
  }
  return signal;
}

Signal query_time(const Series& series) {
  Signal signal{.name = "time of the query (microseconds)", .measured = {}, .ideal = {}};
  for (const double ns : series.time_ns) signal.measured.push_back(1e-3 * ns);
  return signal;
}

/// What should not occur over what should: |T| / (|F| L), and |F| L / |T| in a scenario whose ideal force is zero, with
/// the reference length L; a pure number. Undefined at steps where the ideal has, or the algorithm gives, nothing
/// to divide by.
Signal unwanted_over_wanted(const Series& series) {
  const bool by_force = largest(series.ideal_force) > 0.0;
  const double scale = by_force ? 1.0 / series.reference_length : series.reference_length;
  const auto ratios = [&](const Series::Vectors& force, const Series::Vectors& torque) {
    const Series::Vectors& wanted = by_force ? force : torque;
    const Series::Vectors& unwanted = by_force ? torque : force;
    const double zero = k_zero_fraction * largest(wanted);
    std::vector<double> values;
    for (std::size_t k = 0; k < force.size(); ++k) {
      const double divisor = length(wanted[k]);
      values.push_back(divisor > zero ? scale * length(unwanted[k]) / divisor : std::nan(""));
    }
    return values;
  };
  Signal signal{.name = by_force ? "torque over force" : "force over torque",
                .measured = ratios(series.force, series.torque),
                .ideal = ratios(series.ideal_force, series.ideal_torque)};
  for (std::size_t k = 0; k < signal.ideal.size(); ++k) {
    if (std::isnan(signal.ideal[k])) signal.measured[k] = std::nan("");
  }
  return signal;
}

std::vector<Signal> signals_of(const Series& series) {
  const auto of = [](std::size_t axis) { return [axis](const Vector& v) { return v[axis]; }; };
  std::vector<Signal> signals{component("force, magnitude", series.force, series.ideal_force, length),
                              component("torque, magnitude", series.torque, series.ideal_torque, length),
                              angle("force, angle to the ideal (degrees)", series.force, series.ideal_force),
                              angle("torque, angle to the ideal (degrees)", series.torque, series.ideal_torque),
                              penalty(series),
                              query_time(series)};
  if (series.reference_length > 0.0) signals.push_back(unwanted_over_wanted(series));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    signals.push_back(component("force, component " + name, series.force, series.ideal_force, of(axis)));
    signals.push_back(component("torque, component " + name, series.torque, series.ideal_torque, of(axis)));
  }
  return signals;
}

/// The steps that are drawn: of each stretch the one that is farthest from the ideal, so that no outlier is lost.
std::vector<std::size_t> drawn_steps(const Signal& signal) {
  const std::size_t steps = signal.measured.size();
  const std::size_t stretch = (steps + k_most_steps - 1) / k_most_steps;
  std::vector<std::size_t> drawn;
  const auto off = [&](std::size_t k) {
    const double difference = std::abs(signal.measured[k] - (signal.ideal.empty() ? 0.0 : signal.ideal[k]));
    return std::isfinite(difference) ? difference : -1.0;
  };
  for (std::size_t first = 0; first < steps; first += stretch) {
    std::size_t best = first;
    for (std::size_t k = first; k < std::min(steps, first + stretch); ++k) {
      if (off(k) > off(best)) best = k;
    }
    drawn.push_back(best);
  }
  return drawn;
}

/// "force_signal" is "force, measured", "force_x_signal" is "force, component x".
std::string words_of(const std::string& name) {
  const std::size_t end = name.find('_');
  const std::string kind = name.substr(0, end), what = name.substr(end + 1);
  if (what == "residual") return kind + ", error (measured minus ideal)";
  return what == "signal" ? kind + ", measured" : kind + ", component " + what.substr(0, 1);
}

}  // namespace

DataTable signals_table(const std::vector<Series>& all) {
  DataTable table{.name = "signals",
                  .title = "Responses along the scenarios' paths",
                  .columns = {"scenario", "algorithm", "signal", "curve", "time_ms", "value"},
                  .rows = {}};
  for (const Series& series : all) {
    for (const Signal& signal : signals_of(series)) {
      for (const std::size_t k : drawn_steps(signal)) {
        const double ms = 1e3 * static_cast<double>(k) / series.rate_hz;
        if (!signal.ideal.empty()) {
          table.rows.push_back(
              {series.scenario, series.algorithm, signal.name, std::string("ideal"), ms, signal.ideal[k]});
        }
        table.rows.push_back(
            {series.scenario, series.algorithm, signal.name, std::string("measured"), ms, signal.measured[k]});
      }
    }
  }
  return table;
}

DataTable spectra_table(const std::vector<Series>& all) {
  DataTable table{.name = "spectra",
                  .title = "Time-frequency diagrams of the responses",
                  .columns = {"scenario", "algorithm", "signal", "time_ms", "frequency_hz", "level_db"},
                  .rows = {}};
  for (const Series& series : all) {
    for (const auto& [name, intensity] : series.spectra) {
      // Residuals and components stand on the scale of the magnitude, so that a small one looks small.
      const std::string kind = name.substr(0, name.find('_'));
      double loudest = 0.0;
      for (const auto& [other, values] : series.spectra) {
        if (other == kind + "_signal" && !values.empty()) loudest = *std::ranges::max_element(values);
      }
      const std::string words = words_of(name);
      const std::size_t columns = series.frequencies.size();
      for (std::size_t t = 0; t < series.times.size(); t += k_pieces_apart) {
        for (std::size_t f = 0; f < columns; ++f) {
          const double value = intensity[t * columns + f];
          const double db = value > 0.0 && loudest > 0.0 ? 10.0 * std::log10(value / loudest) : k_floor_db;
          table.rows.push_back({series.scenario, series.algorithm, words, std::round(1e3 * series.times[t]),
                                series.frequencies[f], std::round(10.0 * std::clamp(db, k_floor_db, 0.0)) / 10.0});
        }
      }
    }
  }
  return table;
}

}  // namespace sixdof::report
