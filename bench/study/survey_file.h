#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/study/survey.h"

/// Files of shards of a survey, and the result that they make together.

namespace sixdof::study {

/// What every shard of one algorithm has in common.
struct SurveyIdentity {
  std::string set;        ///< Content hash of the configuration set.
  std::string grid;       ///< Spelling of its grid.
  std::string pair;       ///< Name in rows.
  std::string a, b;       ///< Meshes as a command line takes them.
  std::string algorithm;  ///< With its settings where they are no defaults: base_name(), variant_name().
  std::string version, settings;
  std::string command;  ///< `sixdof query` without a pose.
  std::vector<std::string> questions;
  bool approximates = false;
  bool isolated = false;
  std::string runtime;
  std::size_t shards = 1;
  std::size_t sample = 0;
  std::uint64_t seed = 1;

  bool operator==(const SurveyIdentity&) const = default;
};

/// One shard's answers.
struct SurveyShard {
  SurveyIdentity identity;
  std::size_t number = 1;                                   ///< Of identity.shards, from 1.
  nlohmann::ordered_json context;                           ///< Machine and build.
  double prepare_ns = 0.0;                                  ///< Wall time; structures may have come from the cache.
  double bytes = 0.0;                                       ///< Footprint::bytes.
  std::vector<std::pair<std::string, double>> counts = {};  ///< Footprint::counts.
  std::vector<SurveyCell> cells;
};

/// Written whole or not at all. @throws BadFile
void write_shard(const std::filesystem::path& file, const SurveyShard& shard);

/// @throws BadFile with the file's name if it is no shard of a survey, or damaged
SurveyShard read_shard(const std::filesystem::path& file);

/// Whether a file is there and holds this shard of the same survey.
bool has_shard(const std::filesystem::path& file, const SurveyIdentity& identity, std::size_t number);

/// A result file (results::parse_results()) of all shards: a row of each query and bucket of each algorithm, with the
/// mean and the longest time of single queries by wall clock, and the worst poses; and "survey", how many tests that
/// were. Mean times stand in both means.
/// @param files shards of one or more algorithms on one set, in any order
/// @throws BadFile naming a file that is damaged, or of another set; BadArgument for a shard that is missing or twice
nlohmann::ordered_json survey_document(const std::vector<std::filesystem::path>& files);

}  // namespace sixdof::study
