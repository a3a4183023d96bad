#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/common/study_progress.h"
#include "bench/study/equivalent_rows.h"
#include "bench/study/measurement_store.h"

/// Several searches for equivalent resolutions in one run, with a budget, that may break off and be continued.

namespace sixdof::study {

/// The searches of one algorithm in one scenario: one for each target, all over the same grid.
struct SearchTask {
  std::string scenario, algorithm;
  Settings settings;  ///< Of the parameters that are not searched; with `with_defaults` also of those that are.
  std::string law;    ///< Of the ideal that eta compares with.
  std::array<ResolutionAxis, 2> axes;
  std::vector<SearchOptions> targets;
  bool isolated = false;
  bool with_defaults = false;  ///< Also measures with the settings as they are.
  Measure measure;             ///< Not called twice for the same resolution.
};

/// A search that the budget left out.
struct NotSearched {
  std::string scenario, algorithm;
  SearchOptions options;
  std::optional<double> needs_s;  ///< About how long it would have taken; empty where nothing of it was measured.
  std::string why;                ///< In words, with that time.
};

struct EquivalentRun {
  std::vector<EquivalentResult> results;  ///< In the order of the tasks and their targets.
  std::vector<NotSearched> not_searched;
};

/// Work of measuring at a resolution, where the coarsest values of both axes have 1: the mean over the axes of the
/// count or, of a length, of its inverse square, over that of the coarsest value.
double measurement_work(const std::array<ResolutionAxis, 2>& axes, const Resolution& at);

/// Measures the coarsest and the middle resolution of every task first, estimates from these how long all will take, as
/// a fixed part and one that grows with the work, and then searches task by task. A resolution is measured once, or
/// taken from the store. A search that needs a measurement which is estimated to take longer than what is left of the
/// budget is left out; the next ones are tried all the same.
/// @param store gets every measurement when it is made
/// @param progress has the budget, and gets a part for each measurement after the estimate
/// @param finished is called after every task, with the run so far
/// @throws what the tasks' measure and search_equivalent() throw; Interrupted
EquivalentRun run_searches(const std::vector<SearchTask>& tasks, MeasurementStore& store, StudyProgress& progress,
                           const std::function<void(const EquivalentRun&)>& finished);

}  // namespace sixdof::study
