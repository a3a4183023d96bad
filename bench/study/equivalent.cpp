#include "bench/study/equivalent.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof::study {
namespace {

/// Values of an axis that the search looks at, evenly spaced in the logarithm: 1 % to 3 % apart for ranges of one to
/// three decades, below the tolerance of a prediction.
constexpr std::size_t k_values = 241;

std::vector<double> spaced_values(const ResolutionAxis& axis) {
  std::vector<double> values;
  const double ratio = axis.high / axis.low;
  for (std::size_t i = 0; i < k_values; ++i) {
    values.push_back(axis.low * std::pow(ratio, static_cast<double>(i) / static_cast<double>(k_values - 1)));
  }
  values.back() = axis.high;
  return values;
}

/// A pair of resolutions with what the fits predict.
struct Prediction {
  Resolution at{};
  double given = 0.0;      ///< The quantity that has a target.
  double objective = 0.0;  ///< The quantity that is made least.
};

class Search {
 public:
  Search(const std::array<ResolutionAxis, 2>& axes, const SearchOptions& options, const Measure& measure)
      : axes_(axes), options_(options), measure_(measure) {}

  SearchResult run() {
    for (const double x : axes_[0].grid) {
      for (const double y : axes_[1].grid) {
        result_.grid.push_back(measure_({x, y}));
        points_.push_back(result_.grid.back());
      }
    }
    for (std::size_t k = 0; k <= options_.refinements; ++k) {
      if (!add_step()) break;
      if (within_tolerance(result_.steps.back())) {
        result_.converged = true;
        break;
      }
    }
    result_.chosen = result_.converged ? result_.steps.size() - 1 : best_step();
    return std::move(result_);
  }

 private:
  double given(const Measurement& m) const { return options_.goal == Goal::time ? m.time_ns : m.eta; }
  double objective(const Measurement& m) const { return options_.goal == Goal::time ? m.eta : m.time_ns; }

  /// Samples of one quantity; undefined values are left out.
  std::vector<FitSample> samples(double Measurement::*quantity) const {
    std::vector<FitSample> list;
    for (const Measurement& point : points_) {
      if (!std::isfinite(point.*quantity)) continue;
      list.push_back({point.at[0], point.at[1], point.*quantity});
    }
    return list;
  }

  struct Fits {
    SurfaceFit time, eta;
    std::optional<CorrectedFit> corrected_time, corrected_eta;  ///< In refinements.
    std::optional<SurfaceFit> bytes;

    double time_at(const Resolution& at) const {
      return corrected_time ? corrected_time->at(at[0], at[1]) : time.at(at[0], at[1]);
    }
    double eta_at(const Resolution& at) const {
      return corrected_eta ? corrected_eta->at(at[0], at[1]) : eta.at(at[0], at[1]);
    }
  };

  Fits fit() const {
    const std::vector<FitSample> etas = samples(&Measurement::eta);
    constexpr std::size_t k_plane = 3;
    if (etas.size() < k_plane) {
      throw BadArgument(fmt::format("eta is defined at {} of {} resolutions only: the others give no force",
                                    etas.size(), points_.size()));
    }
    const std::vector<FitSample> times = samples(&Measurement::time_ns);
    Fits fits{fit_plane(times), fit_surface(etas), std::nullopt, std::nullopt, std::nullopt};
    if (!result_.steps.empty()) {
      fits.corrected_time.emplace(fits.time, times);
      fits.corrected_eta.emplace(fits.eta, etas);
    }
    const bool sizes_known = std::ranges::all_of(points_, [](const Measurement& m) { return m.bytes > 0.0; });
    if (options_.largest_bytes > 0.0 && sizes_known) {
      fits.bytes.emplace(FitForm::log_plane, samples(&Measurement::bytes));
    }
    return fits;
  }

  Prediction predict(const Fits& fits, const Resolution& at) const {
    const double time = fits.time_at(at), eta = fits.eta_at(at);
    return options_.goal == Goal::time ? Prediction{at, time, eta} : Prediction{at, eta, time};
  }

  bool allowed(const Fits& fits, const Resolution& at) const {
    return !fits.bytes || fits.bytes->at(at[0], at[1]) <= options_.largest_bytes;
  }

  /// The points where the given quantity meets its target, one for each crossing between neighbouring values of one
  /// axis at each value of the other.
  std::vector<Prediction> line(const Fits& fits) const {
    std::vector<Prediction> found;
    for (const std::size_t moving : {std::size_t{0}, std::size_t{1}}) {
      const std::vector<double> values = spaced_values(axes_[moving]);
      for (const double fixed : spaced_values(axes_[1 - moving])) {
        const auto at = [&](double value) {
          Resolution resolution{};
          resolution[moving] = value;
          resolution[1 - moving] = fixed;
          return resolution;
        };
        const auto excess = [&](double value) { return predict(fits, at(value)).given - options_.target; };
        double before = excess(values.front());
        for (std::size_t i = 1; i < values.size(); ++i) {
          const double after = excess(values[i]);
          if ((before > 0.0) != (after > 0.0)) {
            const double share = before == after ? 0.0 : before / (before - after);
            const Resolution crossing = at(values[i - 1] + share * (values[i] - values[i - 1]));
            if (allowed(fits, crossing)) found.push_back(predict(fits, crossing));
          }
          before = after;
        }
      }
    }
    return found;
  }

  std::vector<Prediction> range(const Fits& fits) const {
    std::vector<Prediction> all;
    for (const double x : spaced_values(axes_[0])) {
      for (const double y : spaced_values(axes_[1])) {
        if (allowed(fits, {x, y})) all.push_back(predict(fits, {x, y}));
      }
    }
    if (all.empty()) throw BadArgument("no resolution of the range fits into the limit of memory");
    return all;
  }

  struct Choice {
    Reach reach = Reach::on_line;
    Resolution at{};
  };

  Choice choose(const Fits& fits) const {
    const auto least = [](const std::vector<Prediction>& list, double Prediction::*quantity) {
      return *std::ranges::min_element(list, {}, quantity);
    };
    const std::vector<Prediction> on_line = line(fits), all = range(fits);
    std::vector<Prediction> below;
    std::ranges::copy_if(all, std::back_inserter(below),
                         [&](const Prediction& p) { return p.given <= options_.target; });
    if (on_line.empty() && below.empty()) return {Reach::above, least(all, &Prediction::given).at};
    if (on_line.empty()) return {Reach::below, least(below, &Prediction::objective).at};
    const Prediction best = least(on_line, &Prediction::objective);
    if (below.empty()) return {Reach::on_line, best.at};
    const Prediction inside = least(below, &Prediction::objective);
    if (inside.objective > (1.0 - k_worthwhile) * best.objective) return {Reach::on_line, best.at};
    return {Reach::inside, inside.at};
  }

  /// Predicts a point and measures it. @returns false if it was measured before as a prediction
  bool add_step() {
    const Fits fits = fit();
    const Choice choice = choose(fits);
    const Resolution at{rounded_value(axes_[0], choice.at[0]), rounded_value(axes_[1], choice.at[1])};
    const auto same = [&](const SearchStep& step) { return step.measured.at == at; };
    if (std::ranges::any_of(result_.steps, same)) return false;
    SearchStep step{.reach = choice.reach,
                    .time_predicted_ns = fits.time_at(at),
                    .eta_predicted = fits.eta_at(at),
                    .measured = measure_(at),
                    .time_form = fits.time.form(),
                    .eta_form = fits.eta.form(),
                    .time_leave_one_out = fits.time.leave_one_out(),
                    .eta_leave_one_out = fits.eta.leave_one_out()};
    points_.push_back(step.measured);
    result_.steps.push_back(step);
    return true;
  }

  bool near(double value, double wanted) const { return std::abs(value - wanted) <= options_.tolerance * wanted; }

  /// Whether a point has the given value as far as the range allows.
  bool meets_target(const SearchStep& step) const {
    const double value = given(step.measured);
    if (step.reach == Reach::below || step.reach == Reach::inside)
      return value <= (1.0 + options_.tolerance) * options_.target;
    return near(value, options_.target);
  }

  bool within_tolerance(const SearchStep& step) const {
    const bool predicted =
        near(step.time_predicted_ns, step.measured.time_ns) && near(step.eta_predicted, step.measured.eta);
    return predicted && (step.reach == Reach::above || meets_target(step));
  }

  std::size_t best_step() const {
    const auto rank = [&](const SearchStep& step) {
      const bool meets = meets_target(step) && std::isfinite(step.measured.eta);
      const double off = std::abs(std::log(given(step.measured) / options_.target));
      const double second = meets ? objective(step.measured) : off;
      return std::pair(meets ? 0 : 1, std::isfinite(second) ? second : std::numeric_limits<double>::max());
    };
    const auto best = std::ranges::min_element(result_.steps, {}, rank);
    return static_cast<std::size_t>(best - result_.steps.begin());
  }

  const std::array<ResolutionAxis, 2>& axes_;
  const SearchOptions& options_;
  const Measure& measure_;
  SearchResult result_;
  std::vector<Measurement> points_;  ///< The grid and all predicted points.
};

void check(const ResolutionAxis& axis) {
  constexpr std::size_t k_fewest = 3;
  const std::set<double> distinct(axis.grid.begin(), axis.grid.end());
  if (distinct.size() < k_fewest || distinct.size() != axis.grid.size()) {
    throw BadArgument(fmt::format("{}: a grid needs at least {} different values", axis.parameter, k_fewest));
  }
  if (!(axis.low > 0.0 && axis.low <= *distinct.begin() && *distinct.rbegin() <= axis.high)) {
    throw BadArgument(fmt::format("{}: the values of the grid must lie between {} and {}, above zero", axis.parameter,
                                  axis.low, axis.high));
  }
}

}  // namespace

void check_axes(const std::array<ResolutionAxis, 2>& axes) {
  for (const ResolutionAxis& axis : axes) check(axis);
}

double rounded_value(const ResolutionAxis& axis, double value) {
  constexpr int k_digits = 4;
  const double exponent = std::floor(std::log10(value)) - (k_digits - 1);
  const double unit = axis.integer ? std::max(1.0, std::pow(10.0, exponent)) : std::pow(10.0, exponent);
  // Division by a whole power of ten gives the double nearest to the decimal number.
  const double rounded = unit < 1.0 ? std::round(value * std::round(1.0 / unit)) / std::round(1.0 / unit)
                                    : std::round(value / unit) * unit;
  return std::clamp(rounded, axis.low, axis.high);
}

SearchResult search_equivalent(const std::array<ResolutionAxis, 2>& axes, const SearchOptions& options,
                               const Measure& measure) {
  check_axes(axes);
  if (!(options.target > 0.0)) throw BadArgument("the given time or eta must be above zero");
  return Search(axes, options, measure).run();
}

}  // namespace sixdof::study
