#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include <sixdof/query/registry.h>
#include "bench/common/study_progress.h"
#include "bench/harness/options.h"
#include "bench/harness/query_kind.h"
#include "bench/study/sweep.h"

namespace sixdof::cli {

/// Options that the studies of pairs share.
struct StudyOptions {
  std::vector<std::string> pairs;
  std::vector<std::string> sets;
  std::string a, b;
  std::vector<std::string> algorithms;
  std::vector<std::string> values;  ///< "ALGORITHM:NAME=VALUE,VALUE".
  std::uint64_t seed = 1;
  std::string budget = "10min";
  std::string output;
  bool json = false;
  ProcessOptions process{.isolate = "third-party"};
};

void add_study_options(CLI::App& command, StudyOptions& options);

/// @param sample configurations per bucket that are read
/// @param arguments the command line for the result's context @throws BadArgument
bench::Options harness_options(const StudyOptions& options, std::size_t sample, std::string arguments);

/// The algorithms that answer the question: those of --algorithms, where "rivals" names all rivals that do, or all of
/// default runs but `null`.
/// @throws BadArgument for one that does not exist or gives no such answer
std::vector<const Algorithm*> study_algorithms(const Registry& registry, const std::vector<std::string>& names,
                                               bench::QueryKind question);

/// @throws BadArgument for an algorithm that is not among `algorithms`
std::vector<study::SweptValues> swept_values(const StudyOptions& options,
                                             const std::vector<const Algorithm*>& algorithms);

/// @throws BadArgument, which lists those that there are, unless `name` is among `known`
void require_metric(const std::string& option, const std::string& name, const std::vector<std::string>& known);

/// Names the algorithms of the registry that are not asked, with the reason why "all" does not include them.
void leave_out_unasked(const Registry& registry, const std::vector<const Algorithm*>& asked, StudyProgress& progress);

/// The command line, for the context of a result.
std::string arguments_of(const std::string& command, const StudyOptions& options);

}  // namespace sixdof::cli
