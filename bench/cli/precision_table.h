#pragma once

#include <string>
#include <vector>

#include "bench/cli/table.h"
#include "bench/study/precision.h"

namespace sixdof::cli {

/// One line per point; '*' is on the frontier of all, '+' on that of its own algorithm. Below: orders, what was left
/// out and why, and what the study could not decide.
Sheet precision_sheet(const study::PrecisionStudy& study);

/// For every algorithm and setting that several studies measured with a gain: its largest over its least value, as
/// lines. A force law that fits all pairs with one stiffness has a ratio of 1. Empty for fewer than two studies.
std::vector<std::string> gain_spreads(const std::vector<const study::PrecisionStudy*>& studies);

}  // namespace sixdof::cli
