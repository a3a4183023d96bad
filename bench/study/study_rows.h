#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/common/row_fields.h"

/// Results of studies in the format of `sixdof-bench`: Google Benchmark's JSON, so that its compare.py reads them.

namespace sixdof::study {

struct StudyRow {
  std::string name;  ///< API: "precision/respond/algorithm:vps/pair:bunny/voxel_size:0.004".
  RowFields fields;
  double real_time_ns = 0.0;                             ///< Mean wall-clock time of a query.
  double cpu_time_ns = 0.0;                              ///< Mean processor time of a query.
  std::vector<std::pair<std::string, double>> counters;  ///< In the table of metrics (lib/sixdof/measure/metrics.h).
  std::string label;
  std::string error;  ///< Why there is no result; empty if there is one. Then times and counters mean nothing.
};

/// One entry of "benchmarks". @throws Error for a counter that is not finite, or that the table of metrics lacks
nlohmann::ordered_json to_json_object(const StudyRow& row);

/// {"context": ..., "benchmarks": [...]}. @param context of the run (bench/harness/run_context.h) @throws Error
nlohmann::ordered_json study_document(const nlohmann::ordered_json& context, const std::vector<StudyRow>& rows);

/// Writes the document, whole or not at all. @throws BadFile, Error
void write_study_rows(const std::filesystem::path& file, const nlohmann::ordered_json& context,
                      const std::vector<StudyRow>& rows);

}  // namespace sixdof::study
