#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <sixdof/query/registry.h>
#include "bench/harness/options.h"

namespace sixdof::bench {

/// The "context" of a result file when a run begins: Google Benchmark's own keys, build, processor, algorithms with
/// their settings, options. The store adds "mesh:NAME" and "set:NAME", the content hashes of what rows use.
/// @param settings of every algorithm, by name
/// @param is_asked which algorithms it names; all without it
nlohmann::ordered_json run_context(const Options& options, const Registry& registry,
                                   const std::map<std::string, Settings>& settings,
                                   const std::function<bool(const Traits&)>& is_asked = {});

/// Why rows of two runs do not belong in one file: another machine, build, algorithm, setting, sample, seed or way to
/// measure. "sample is 64, now 32; ..."; empty if they belong together. The choice of rows and --budget may differ,
/// since a row's counters say how many configurations or steps it had time for.
std::string difference_of_contexts(const nlohmann::ordered_json& before, const nlohmann::ordered_json& now);

/// Likewise, for meshes and sets that both runs used.
std::string difference_of_hashes(const nlohmann::ordered_json& before, const nlohmann::ordered_json& now);

/// Whether a key of the context is "mesh:NAME" or "set:NAME".
bool is_hash(std::string_view key);

}  // namespace sixdof::bench
