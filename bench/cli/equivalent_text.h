#pragma once

#include <span>
#include <string>

#include "bench/study/equivalent_rows.h"

/// The text that `sixdof equivalent` prints.

namespace sixdof::cli {

/// One search: the grid, the fits, predicted beside measured, and the answer as parameters. @param weights of eta
void print_equivalent(const study::EquivalentResult& result, const std::string& weights);

/// For each algorithm the mean difference of predicted and measured eta, beside the values that the paper prints.
void print_prediction_errors(std::span<const study::EquivalentResult> results);

}  // namespace sixdof::cli
