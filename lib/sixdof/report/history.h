#pragma once

#include <cstddef>
#include <vector>

#include <sixdof/report/data_table.h>
#include <sixdof/results/results.h>
#include <sixdof/results/row_group.h>

namespace sixdof::report {

using namespace results;

/// Where the level of a series of logarithms changes: indices of the first value of each later level, increasing. A
/// change is kept if the means on both sides differ by more than k_change_standard_errors standard errors and by more
/// than a factor of k_least_factor; the noise is estimated from neighbouring differences, which a few changes do not
/// widen. The halves are searched again.
std::vector<std::size_t> change_points(const std::vector<double>& logarithms);

inline constexpr double k_change_standard_errors = 5.0, k_least_factor = 1.1;

/// Column of history_table() with the factor.
inline constexpr std::size_t k_history_change = 9;

/// "history": mean processor time of every row in every file. `machine` counts the stretches of files that were
/// measured on one machine with one kind of build: lines are broken between them, and change points are searched within
/// them. `change` is the factor to the level before at a change point, otherwise empty.
DataTable history_table(const Results& results, const std::vector<RowGroup>& groups);

}  // namespace sixdof::report
