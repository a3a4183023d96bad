#include "bench/study/equivalent_run.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include "bench/common/duration.h"
#include "bench/common/interrupt.h"

namespace sixdof::study {
namespace {

/// Predictions that a search measures besides the grid; it stops after one to six.
constexpr std::size_t k_predictions = 2;

/// What is left of the budget is too short for a measurement.
struct OutOfBudget : Error {
  using Error::Error;
};

double fineness(const ResolutionAxis& axis, double value) {
  const auto [least, largest] = std::ranges::minmax(axis.grid);
  if (axis.integer) return std::max(value, least) / least;  // 0 stands for as many as of the other body
  return largest * largest / (value * value);
}

Resolution coarsest(const std::array<ResolutionAxis, 2>& axes) {
  const auto value = [](const ResolutionAxis& axis) {
    return axis.integer ? std::ranges::min(axis.grid) : std::ranges::max(axis.grid);
  };
  return {value(axes[0]), value(axes[1])};
}

/// That of the grid with as many coarser as finer values of each axis.
Resolution middle(const std::array<ResolutionAxis, 2>& axes) {
  const auto value = [](const ResolutionAxis& axis) {
    std::vector<double> values = axis.grid;
    std::ranges::sort(values);
    return values[values.size() / 2];
  };
  return {value(axes[0]), value(axes[1])};
}

Resolution default_resolution(const SearchTask& task) {
  return {task.settings.number(task.axes[0].parameter), task.settings.number(task.axes[1].parameter)};
}

/// What measurements of one kind have taken: seconds = fixed + slope work, since making the scenario, walking its path
/// and evaluating it take the same time at every resolution.
class Spent {
 public:
  void add(double work, double seconds) { points_.emplace_back(work, seconds); }
  void add(const Spent& other) { points_.insert(points_.end(), other.points_.begin(), other.points_.end()); }
  bool empty() const { return points_.empty(); }

  /// By least squares, without a part below zero; proportional to the work where all had the same. Not empty.
  double expected(double work) const {
    const double count = static_cast<double>(points_.size());
    double works = 0.0, seconds = 0.0, squares = 0.0, products = 0.0;
    for (const auto& [w, s] : points_) {
      works += w;
      seconds += s;
      squares += w * w;
      products += w * s;
    }
    const double variance = squares - works * works / count;
    constexpr double k_spread = 1e-9;  // of equal works, by rounding
    const double slope = variance > k_spread * squares ? (products - works * seconds / count) / variance : -1.0;
    const double fixed = (seconds - slope * works) / count;
    if (variance <= k_spread * squares || fixed < 0.0) return seconds / works * work;
    return slope < 0.0 ? seconds / count : fixed + slope * work;
  }

 private:
  std::vector<std::pair<double, double>> points_;  ///< Work, seconds.
};

class Run {
 public:
  Run(const std::vector<SearchTask>& tasks, MeasurementStore& store, StudyProgress& progress)
      : tasks_(tasks), store_(store), progress_(progress) {
    for (const SearchTask& task : tasks_) targets_left_.push_back(task.targets.size());
    for (const SearchTask& task : tasks_) {
      for (const auto& [key, entry] : store_.entries()) {
        const auto& [scenario, algorithm, at] = key;
        if (scenario == task.scenario && algorithm == task.algorithm) note(task, at, entry.seconds);
      }
    }
  }

  EquivalentRun run(const std::function<void(const EquivalentRun&)>& finished) {
    progress_.begin(plan(), 1.0);
    measure_first();
    if (const std::optional<double> all = remaining_s()) progress_.estimate(*all, *all);
    counts_ = true;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      search(i);
      finished(run_);
    }
    return std::move(run_);
  }

 private:
  static MeasurementStore::Key key_of(const SearchTask& task, const Resolution& at) {
    return {task.scenario, task.algorithm, at};
  }

  void note(const SearchTask& task, const Resolution& at, double seconds) {
    spent_[{task.scenario, task.algorithm}].add(measurement_work(task.axes, at), seconds);
  }

  /// By the task's own measurements, else by those of its algorithm in other scenarios; empty without any.
  std::optional<double> expected_s(const SearchTask& task, const Resolution& at) const {
    Spent own, of_algorithm;
    for (const auto& [names, spent] : spent_) {
      if (names.second != task.algorithm) continue;
      if (names.first == task.scenario) own = spent;
      of_algorithm.add(spent);
    }
    const Spent& known = own.empty() ? of_algorithm : own;
    if (known.empty()) return std::nullopt;
    return known.expected(measurement_work(task.axes, at));
  }

  /// Resolutions of the task that are measured in any case.
  static std::vector<Resolution> fixed_resolutions(const SearchTask& task) {
    std::vector<Resolution> list;
    for (const double x : task.axes[0].grid) {
      for (const double y : task.axes[1].grid) list.push_back({x, y});
    }
    if (!task.with_defaults) return list;
    const Resolution defaults = default_resolution(task);
    if (std::ranges::find(list, defaults) == list.end()) list.push_back(defaults);
    return list;
  }

  /// What the task still needs. Empty where nothing tells.
  std::optional<double> needed_s(const SearchTask& task) const {
    double seconds = 0.0, grid_s = 0.0;
    std::size_t known = 0;
    const std::vector<Resolution> fixed = fixed_resolutions(task);
    for (const Resolution& at : fixed) {
      const std::optional<double> expected = expected_s(task, at);
      if (!expected) return std::nullopt;
      grid_s += *expected;
      const bool is_known = store_.find(key_of(task, at)) != nullptr;
      if (is_known) ++known;
      if (!is_known) seconds += *expected;
    }
    const std::size_t predicted = measured_count(task) - known, wanted = k_predictions * task.targets.size();
    const std::size_t predictions = wanted > predicted ? wanted - predicted : 0;
    return seconds + static_cast<double>(predictions) * grid_s / static_cast<double>(fixed.size());
  }

  std::size_t measured_count(const SearchTask& task) const {
    return static_cast<std::size_t>(std::ranges::count_if(store_.entries(), [&](const auto& each) {
      return std::get<0>(each.first) == task.scenario && std::get<1>(each.first) == task.algorithm;
    }));
  }

  /// Of all tasks. Empty where nothing tells.
  std::optional<double> remaining_s() const {
    double seconds = 0.0;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      if (targets_left_[i] == 0) continue;
      const std::optional<double> needed = needed_s(tasks_[i]);
      if (!needed) return std::nullopt;
      seconds += *needed;
    }
    return seconds;
  }

  std::string plan() const {
    std::size_t targets = 0, settings = 0, known = 0;
    for (const SearchTask& task : tasks_) {
      targets += task.targets.size();
      for (const Resolution& at : fixed_resolutions(task)) {
        ++settings;
        known += store_.find(key_of(task, at)) != nullptr ? 1 : 0;
      }
    }
    return fmt::format("{} search{}: {} settings, of which {} are measured, and about {} predictions", targets,
                       targets == 1 ? "" : "es", settings, known, k_predictions * targets);
  }

  /// Tells how long the others will take: one alone would not tell what is fixed from what grows with the resolution.
  void measure_first() {
    for (const SearchTask& task : tasks_) {
      try {
        measure(task, coarsest(task.axes));
        measure(task, middle(task.axes));
      } catch (const OutOfBudget&) {
        return;  // search() names the searches
      }
    }
  }

  Measurement measure(const SearchTask& task, const Resolution& at) {
    if (const auto* const known = store_.find(key_of(task, at)); known != nullptr) return known->measured;
    InterruptGuard::check();
    const double left = progress_.left_s();
    if (left <= 0.0) throw OutOfBudget("the budget was spent");
    if (const auto expected = expected_s(task, at); expected && *expected > left) {
      throw OutOfBudget(fmt::format("{} would take about {}, and {} of the budget were left",
                                    resolution_text(task.axes, at), duration_text(*expected), duration_text(left)));
    }
    const std::string part = fmt::format("{} {} {}", task.scenario, task.algorithm, resolution_text(task.axes, at));
    progress_.status(part);
    const auto start = std::chrono::steady_clock::now();
    Measurement measured = task.measure(at);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    store_.add(key_of(task, at), {.measured = measured, .seconds = seconds});
    note(task, at, seconds);
    if (counts_) {
      progress_.set_remaining(seconds + remaining_s().value_or(0.0));
      progress_.finished(part, seconds);
    }
    return measured;
  }

  std::optional<Measurement> measured_defaults(const SearchTask& task) {
    if (!task.with_defaults) return std::nullopt;
    try {
      return measure(task, default_resolution(task));
    } catch (const OutOfBudget& e) {
      progress_.leave_out(fmt::format("{} {} by default", task.scenario, task.algorithm), e.what());
      return std::nullopt;
    }
  }

  void search(std::size_t index) {
    const SearchTask& task = tasks_[index];
    const std::optional<Measurement> defaults = measured_defaults(task);
    for (const SearchOptions& target : task.targets) {
      try {
        const Measure here = [&](const Resolution& at) { return measure(task, at); };
        run_.results.push_back({.scenario = task.scenario,
                                .algorithm = task.algorithm,
                                .settings = task.settings,
                                .law = task.law,
                                .axes = task.axes,
                                .options = target,
                                .search = search_equivalent(task.axes, target, here),
                                .isolated = task.isolated,
                                .at_defaults = defaults});
      } catch (const OutOfBudget& e) {
        leave_out(task, target, e.what());
      }
      --targets_left_[index];
    }
  }

  void leave_out(const SearchTask& task, const SearchOptions& target, const std::string& why) {
    NotSearched left{.scenario = task.scenario,
                     .algorithm = task.algorithm,
                     .options = target,
                     .needs_s = needed_s(task),
                     .why = why};
    if (left.needs_s) left.why += fmt::format("; about {} more are needed", duration_text(*left.needs_s));
    progress_.leave_out(fmt::format("{} {} at {}", task.scenario, task.algorithm, given_text(target)), left.why);
    run_.not_searched.push_back(std::move(left));
  }

  const std::vector<SearchTask>& tasks_;
  MeasurementStore& store_;
  StudyProgress& progress_;
  EquivalentRun run_;
  std::vector<std::size_t> targets_left_;                       ///< By task.
  std::map<std::pair<std::string, std::string>, Spent> spent_;  ///< By scenario and algorithm.
  bool counts_ = false;  ///< Whether measurements are parts: not before the estimate.
};

}  // namespace

double measurement_work(const std::array<ResolutionAxis, 2>& axes, const Resolution& at) {
  return 0.5 * (fineness(axes[0], at[0]) + fineness(axes[1], at[1]));
}

EquivalentRun run_searches(const std::vector<SearchTask>& tasks, MeasurementStore& store, StudyProgress& progress,
                           const std::function<void(const EquivalentRun&)>& finished) {
  return Run(tasks, store, progress).run(finished);
}

}  // namespace sixdof::study
