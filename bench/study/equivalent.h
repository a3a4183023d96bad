#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/study/plane_fit.h"

/// Equivalent resolutions (Weller et al. 2010, section 3.2.3): of the resolutions of A and B with which an algorithm
/// takes a given mean time, the pair with the least error.

namespace sixdof::study {

/// One of the two resolutions that are searched: a numeric parameter of an algorithm.
struct ResolutionAxis {
  std::string parameter;
  std::vector<double> grid;  ///< At least three distinct values, in any order; all are measured.
  double low = 0.0;          ///< Smallest and largest value that the search may take.
  double high = 0.0;
  bool integer = false;
};

/// The values of both axes.
using Resolution = std::array<double, 2>;

/// What one resolution gives.
struct Measurement {
  Resolution at{};
  double time_ns = 0.0;  ///< Mean processor time of a query, > 0.
  double eta = 0.0;      ///< Error >= 0, a pure number; NaN where it is not defined.
  double bytes = 0.0;    ///< Of the prepared structures; 0 if unknown.
  /// Further results by their name in the table of metrics. The search does not use them.
  std::vector<std::pair<std::string, double>> counters = {};
};

/// Which of the two is given; the other one is made least.
enum class Goal {
  time,  ///< The mean time is given: the least eta. The paper's (4).
  eta,   ///< eta is given: the least mean time.
};

/// Where the given value lies.
enum class Reach {
  on_line,  ///< The best resolution has the given value.
  inside,   ///< Some have the given value, but one that is faster (or better) than asked for beats them all.
  below,    ///< All of the range is below it: faster (or better) than asked for.
  above,    ///< All of the range is above it: slower (or worse).
};

struct SearchOptions {
  Goal goal = Goal::time;
  double target = 0.0;          ///< tau in ns, or eta; > 0.
  double tolerance = 0.1;       ///< A prediction off by more than this fraction is refined.
  std::size_t refinements = 5;  ///< At most so many.
  double largest_bytes = 0.0;   ///< The search leaves out resolutions predicted to need more; 0: no limit.
};

/// A pair of resolutions that the fits chose, and what was measured there.
struct SearchStep {
  Reach reach = Reach::on_line;
  double time_predicted_ns = 0.0;
  double eta_predicted = 0.0;
  Measurement measured;
  FitForm time_form = FitForm::plane;  ///< Of the fits that chose it, with their errors of leave-one-out.
  FitForm eta_form = FitForm::plane;
  double time_leave_one_out = 0.0;
  double eta_leave_one_out = 0.0;
};

struct SearchResult {
  std::vector<Measurement> grid;
  std::vector<SearchStep> steps;  ///< The first prediction, then its refinements; never empty.
  std::size_t chosen = 0;         ///< The step that is the answer.
  bool converged = false;         ///< The answer is within the tolerance.

  const SearchStep& first() const { return steps.front(); }
  const SearchStep& answer() const { return steps[chosen]; }
};

/// Prepares and measures one resolution within the range of the axes, or recalls what it measured there before.
using Measure = std::function<Measurement(const Resolution&)>;

/// Measures the grid, fits planes to the time (fit_plane) and a surface to eta (fit_surface), and predicts the best
/// resolution on the line where the given value is met, which is then measured. If time or eta is off by more than the
/// tolerance, the fits are repeated with that point and corrected by interpolated residuals (CorrectedFit), and a new
/// point is predicted and measured, until it is within the tolerance or was predicted before.
///
/// The given value is the greatest that is admissible. If a resolution below it is predicted to be better than all on
/// the line by k_worthwhile, it is taken. Where the range of the axes does not reach the given value, the answer is the
/// best resolution of the whole range if all are below it, the nearest to the given value if all are above.
///
/// The answer is the last point if within the tolerance. Otherwise, of all predicted points: the one with the least
/// objective among those that meet the given value to the tolerance, else the one nearest to the given value.
/// @throws BadArgument if an axis has fewer than three values or values out of range, or eta is not defined at enough
/// resolutions to fit a plane
SearchResult search_equivalent(const std::array<ResolutionAxis, 2>& axes, const SearchOptions& options,
                               const Measure& measure);

/// @throws BadArgument if an axis has fewer than three values, or values out of its range
void check_axes(const std::array<ResolutionAxis, 2>& axes);

/// Fraction of the objective for which the search leaves the line: less than what predictions are off by.
inline constexpr double k_worthwhile = 0.05;

/// The allowed value next to `value`: within the axis's range, with four significant digits, whole for an integer axis.
double rounded_value(const ResolutionAxis& axis, double value);

}  // namespace sixdof::study
