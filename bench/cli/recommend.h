#pragma once

#include <string>
#include <string_view>
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

/// "yes-no", "distance", "respond".
std::string_view words_of(bench::QueryKind question);

/// The answer to one question.
struct Verdict {
  bench::QueryKind question;
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
