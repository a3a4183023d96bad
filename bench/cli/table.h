#pragma once

#include <string>

#include <CLI/App.hpp>

namespace sixdof::cli {

/// `sixdof table FILE.json`: the results of sixdof-bench as one table per pair and kind of bucket.
void add_table_command(CLI::App& app);

/// The same from the text of a result file: one line per kind of query and algorithm, one column per bucket. Times are
/// in microseconds. '!' marks a row with wrong answers, '?' one with queries that failed.
/// @param file named in messages. @throws BadFile if the text is no result file
std::string results_table(const std::string& text, const std::string& file);

}  // namespace sixdof::cli
