#pragma once

#include <string>
#include <vector>

#include <sixdof/report/data_table.h>
#include <sixdof/results/results.h>
#include <sixdof/results/row_group.h>

namespace sixdof::report {

using namespace results;

/// What a report says first.
struct Summary {
  /// Which algorithm is the fastest without a wrong answer, how wrong the others are, what failed. Never empty.
  std::vector<std::string> sentences;
  /// "winners": the fastest right algorithm, a line for each query, pair, bucket and order of poses with two rows or
  /// more that have no fault; and, where it is another one, the fastest of these (contest.h), which is not right.
  DataTable winners;
};

/// An algorithm is right for a query, by all its rows on buckets: for yes/no and distance if it does not approximate
/// and no row has a fault (fault.h); for responses if no row has a fault and the mean of its mean angles to the exact
/// forces is at most 1 degree. The sentences and the table rank by the mean processor time (RowGroup::mean_time()) of
/// algorithms that are right. One wins clearly if its interval ends below that of the next; otherwise they tie.
Summary summarise(const Results& results, const std::vector<RowGroup>& groups);

}  // namespace sixdof::report
