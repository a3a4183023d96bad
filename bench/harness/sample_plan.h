#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bench/harness/row.h"

namespace sixdof::bench {

/// What rows have in common that differ in the algorithm alone: query, bodies, bucket, order, state of the caches and
/// limit of the sample. Empty for rows that ask no configurations of a bucket.
std::string group_of(const results::RowFields& fields);

/// How many configurations rows ask. All rows of a group ask the same ones, so that slow and fast algorithms are
/// compared on the same poses. The number is chosen before the first row of the group is measured, such that the whole
/// group fits into its time.
class SamplePlan {
 public:
  /// @param rows those that are to be measured; they outlive this object
  explicit SamplePlan(const std::vector<const PlannedRow*>& rows);

  /// Takes over a row of an earlier run: the others of its group ask as many configurations.
  void keep(const results::RowFields& measured);

  /// Share::configurations of a row. Where there is a limit of time, the first call for a group asks trial() of its
  /// rows; those that throw or have no answer take no time.
  /// @param row_seconds wall time that each row may take at the moment, infinity without a limit
  /// @throws Interrupted
  std::size_t configurations(const PlannedRow& row, const std::function<double()>& row_seconds);

  /// Enough for a mean. Rows ask at least so many, even if that takes longer than their time.
  static constexpr std::size_t k_fewest = 32;

 private:
  std::map<std::string, std::vector<const PlannedRow*>> rows_;  ///< By group.
  std::map<std::string, std::size_t> configurations_;           ///< By group, where it is known.
};

}  // namespace sixdof::bench
