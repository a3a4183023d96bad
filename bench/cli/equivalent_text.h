#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/results/paper_table.h>
#include "bench/cli/table.h"
#include "bench/study/equivalent_rows.h"
#include "bench/study/equivalent_run.h"

/// The text that `sixdof equivalent` prints, and the members of its JSON besides rows.

namespace sixdof::cli {

/// One search: the grid, the fits, predicted beside measured, and the answer as parameters. @param weights of eta
void print_equivalent(const study::EquivalentResult& result, const std::string& weights);

/// For each algorithm the mean difference of predicted and measured eta, beside the values that the paper prints.
Sheet prediction_sheet(std::span<const study::EquivalentResult> results);

/// A sheet for each mean time. @param lines of results::paper_lines()
std::vector<Sheet> paper_sheets(std::span<const results::PaperLine> lines);

/// A list of objects with the printed value, and value and verdict of each reading.
nlohmann::ordered_json paper_json(std::span<const results::PaperLine> lines);

/// "not searched: Ia ist at tau = 0.9ms: WHY".
std::vector<std::string> not_searched_lines(std::span<const study::NotSearched> list);
nlohmann::ordered_json not_searched_json(std::span<const study::NotSearched> list);

}  // namespace sixdof::cli
