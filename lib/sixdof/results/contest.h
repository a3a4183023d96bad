#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <sixdof/results/row_group.h>

/// Which algorithm is the fastest.

namespace sixdof::results {

/// The rows of a file that compete: one query on one bucket of the same bodies_of(), with one order of poses, on warm
/// caches. Interpreted algorithms compete with none that are compiled.
struct Contest {
  std::size_t file = 0;
  std::string query, bodies, order;
  BucketKey bucket;
  /// Those that have a processor time and no fault, at least one: by mean_time(), the fastest first, of equal times in
  /// the order of the file.
  std::vector<const RowGroup*> entries;

  const RowGroup& winner() const { return *entries.front(); }
  /// Of two entries or more: whether the interval of the winner's time lies below that of the next.
  bool is_clear() const;
  /// Time of the next over that of the winner.
  double factor() const;
};

/// In the order of the groups. @param groups outlive the contests
std::vector<Contest> contests(std::span<const RowGroup> groups);

}  // namespace sixdof::results
