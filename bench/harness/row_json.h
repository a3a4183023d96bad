#pragma once

#include <functional>
#include <map>
#include <string>

#include <benchmark/benchmark.h>
#include <nlohmann/json_fwd.hpp>

#include <sixdof/results/outliers.h>
#include <sixdof/results/row_fields.h>

namespace sixdof::bench {

/// The fields of every row by its name.
using FieldsByName = std::map<std::string, results::RowFields>;
/// PlannedRow::outliers of the rows that have it, by name.
using OutliersByName = std::map<std::string, std::function<results::Outliers()>>;

/// One finished row, or one aggregate of its repetitions, as it stands in a result file's "benchmarks": Google
/// Benchmark's keys, the row's fields under k_row_fields_key, its outliers under k_outliers_key. Strings are visible.
/// @throws Error for a NaN in it
nlohmann::ordered_json row_json(const benchmark::BenchmarkReporter::Run& run, const FieldsByName& fields,
                                const OutliersByName& outliers);

}  // namespace sixdof::bench
