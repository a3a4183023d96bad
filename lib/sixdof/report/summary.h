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
  DataTable winners;  ///< "winners": the fastest without a fault, a line per query, pair and bucket.
};

/// An algorithm wins a bucket if its mean processor time is the least among ranked rows (is_ranked). It wins clearly if
/// its interval (processor_time) ends below that of the next one; otherwise the two are a tie.
Summary summarise(const Results& results, const std::vector<RowGroup>& groups);

}  // namespace sixdof::report
