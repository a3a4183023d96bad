#include "bench/harness/run_context.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/own_command.h>
#include <sixdof/base/shell_text.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/process/remote_algorithm.h>
#include "bench/common/build_info.h"
#include "bench/harness/suite.h"
#include "bench/harness/timing.h"

namespace sixdof::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Google Benchmark's keys: date, host, processor, caches, load.
Json context_of_benchmark() {
  std::ostringstream text;
  benchmark::JSONReporter writer;
  writer.SetOutputStream(&text);
  writer.ReportContext(benchmark::BenchmarkReporter::Context());
  writer.Finalize();
  return Json::parse(visible_json(text.str())).at("context");
}

/// Whether times or answers of a row depend on what stands under this key.
bool matters(std::string_view key) {
  static const std::set<std::string_view> k_keys{
      "num_cpus",     "sixdof_version", "commit", "commit_dirty", "compiler",        "flags",     "build_type",
      "sixdof_build", "cpu_model",      "seed",   "sample",       "benchmark_flags", "fcl_build", "isolated"};
  return k_keys.contains(key) || key.starts_with("version:") || key.starts_with("algorithm:") ||
         key.starts_with("settings:");
}

std::string value_of(const Json& context, const std::string& key) {
  const auto found = context.find(key);
  if (found == context.end()) return "missing";
  return found->is_string() ? found->get<std::string>() : found->dump();
}

/// "KEY was X, is Y; ..." of those keys.
std::string differences(const Json& before, const Json& now, const std::set<std::string>& keys) {
  std::vector<std::string> list;
  for (const std::string& key : keys) {
    const std::string old_value = value_of(before, key), new_value = value_of(now, key);
    if (old_value != new_value) list.push_back(fmt::format("{} was {}, now it is {}", key, old_value, new_value));
  }
  return fmt::format("{}", fmt::join(list, "; "));
}

}  // namespace

std::string Options::reproduction_words() const {
  std::string words;
  const auto add = [&](const std::string& option, const std::string& value) {
    words += fmt::format("{}{} {}", words.empty() ? "" : " ", option, shell_quoted(value));
  };
  if (!a.empty()) add("--a", a);
  if (!b.empty()) add("--b", b);
  if (!sets.empty() && manifest.empty()) words += words.empty() ? "--no-manifest" : " --no-manifest";
  if (!own_pair() && !manifest.empty() && manifest != default_manifest()) add("--manifest", manifest.string());
  for (const auto& set : sets) add("--set", set.string());
  for (const auto& mesh : meshes) add("--mesh", mesh.string());
  for (const std::string& parameter : parameters) add("-p", parameter);
  words += process_words(process);
  if (own_pair()) words += " --suite all";
  // Its variants exist under this list alone.
  const bool has_variants = !own_pair() && !suite.empty() && !suite_variants(suite).empty();
  if (has_variants) add("--suite", suite_word);
  return words.starts_with(' ') ? words.substr(1) : words;
}

Json run_context(const Options& options, const Registry& registry, const std::map<std::string, Settings>& settings,
                 const std::function<bool(const Traits&)>& is_asked) {
  Json context = context_of_benchmark();
  for (const auto& [key, value] : build_info()) context[key] = value;
  std::vector<std::string> isolated;
  for (const auto& algorithm : registry.all()) {
    const Traits& traits = algorithm->traits();
    if (is_asked && !is_asked(traits)) continue;
    if (is_isolated(*algorithm)) isolated.push_back(traits.name);
    context["algorithm:" + traits.name] = traits.version;
    const std::string text = settings.at(traits.name).to_string();
    if (!text.empty()) context["settings:" + traits.name] = text;
  }
  if (!isolated.empty()) context["isolated"] = fmt::format("{}", fmt::join(isolated, ","));
  context["arguments"] = options.arguments;
  context["program"] = own_command(options.program);
  context["reproduction"] = options.reproduction_words();
  context["benchmark_flags"] = options.benchmark_flags;
  context["seed"] = std::to_string(options.seed);
  context["sample"] = std::to_string(options.sample);
  context["budget_s"] = fmt::format("{}", options.budget_s);
  context["clock_overhead_ns"] = fmt::format("{:.0f}", clock_overhead_ns());
  return context;
}

std::string difference_of_contexts(const Json& before, const Json& now) {
  std::set<std::string> keys;
  for (const Json* const context : {&before, &now}) {
    for (const auto& item : context->items()) {
      if (matters(item.key())) keys.insert(item.key());
    }
  }
  return differences(before, now, keys);
}

std::string difference_of_hashes(const Json& before, const Json& now) {
  std::set<std::string> keys;
  for (const auto& item : now.items()) {
    if (is_hash(item.key()) && before.contains(item.key())) keys.insert(item.key());
  }
  return differences(before, now, keys);
}

bool is_hash(std::string_view key) { return key.starts_with("mesh:") || key.starts_with("set:"); }

}  // namespace sixdof::bench
