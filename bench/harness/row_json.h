#pragma once

#include <map>
#include <string>

#include <benchmark/benchmark.h>
#include <nlohmann/json_fwd.hpp>

#include "bench/common/row_fields.h"

namespace sixdof::bench {

/// The fields of every row by its name.
using FieldsByName = std::map<std::string, RowFields>;

/// One finished row, or one aggregate of its repetitions, as it stands in a result file's "benchmarks": Google
/// Benchmark's keys and the row's fields under k_row_fields_key. Strings are UTF-8. @throws Error for a NaN in it
nlohmann::ordered_json row_json(const benchmark::BenchmarkReporter::Run& run, const FieldsByName& fields);

}  // namespace sixdof::bench
