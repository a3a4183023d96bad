#pragma once

#include <string>
#include <vector>

#include <sixdof/configuration/set_catalogue.h>
#include <sixdof/results/choice.h>
#include "bench/cli/study_options.h"
#include "bench/study/precision.h"

/// What `sixdof recommend` measures (recommend.cpp) and prints (recommend_text.cpp).

namespace sixdof::cli {

struct RecommendOptions {
  StudyOptions study{.budget = "3min"};
  std::string question = "all";
  std::string deadline = "1ms";
  std::string metric;  ///< Empty: the usual one of each question.
  std::string order = "random";
  unsigned threads = 1;

  bool in_motion() const { return order == "motion"; }
};

/// "yes-no" for "collide"; the others as they are: "distance", "respond", "cast".
std::string words_of(const std::string& query);

/// The answer to one question.
struct Verdict {
  std::string query;  ///< "collide", "distance", "respond", "cast".
  std::string metric;
  std::string poses = {};                                  ///< What was judged, in words.
  std::vector<results::Row> rows = {};                     ///< Of all settings,
  std::vector<std::vector<std::string>> assignments = {};  ///< and what tells them from others of their algorithm.
  results::Choice choice = {};
};

void print_text(const RecommendOptions& options, double deadline_s, const CatalogueEntry& pair,
                const std::vector<Verdict>& verdicts);
void print_json(const RecommendOptions& options, double deadline_s, const CatalogueEntry& pair,
                const std::vector<Verdict>& verdicts);

}  // namespace sixdof::cli
