#pragma once

#include <vector>

#include "bench/harness/options.h"
#include "bench/harness/row.h"

namespace sixdof::bench {

/// Runs, or lists, the rows that --benchmark_filter chooses. The result file appears whole or not at all; every
/// finished row is in its journal before (result_store.h).
/// - A row that throws is reported as an error, and the rest go on.
/// - Rows that need solids where a mesh is none are left out; one line on stderr counts them.
/// - After Ctrl-C the file has the rows that were finished, and "interrupted": "true" in its context.
/// @throws BadArgument if no row matches; Interrupted; Error if a row could not be run or the file not be written
void run_rows(const std::vector<PlannedRow>& rows, const Options& options, const Resources& resources);

}  // namespace sixdof::bench
