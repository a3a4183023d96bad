#include "bench/common/rivals.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>
#include <sixdof/process/protocol.h>
#include <sixdof/process/remote_algorithm.h>

namespace sixdof {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> k_runtimes{"native", "python", "node", "wasm"};

std::filesystem::path folder_of(const char* variable) {
  const char* const value = std::getenv(variable);
  return value == nullptr ? "" : value;
}

std::vector<std::filesystem::path> ready_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (folder.empty()) return files;
  std::error_code error;
  std::filesystem::directory_iterator at(folder / "ready", error);
  for (; !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
    if (at->path().extension() == ".json") files.push_back(at->path());
  }
  std::ranges::sort(files);
  return files;
}

/// @throws BadFile
std::unique_ptr<Algorithm> read_rival(const std::filesystem::path& file, const ProcessLimits& limits) {
  std::ifstream in(file);
  if (!in) throw BadFile(file.string(), "cannot be opened");
  try {
    const Json json = Json::parse(in);
    Traits traits = protocol::greeting_of(json.at("hello").dump()).traits;
    traits.name = json.at("name").get<std::string>();
    traits.runtime = json.at("runtime").get<std::string>();
    traits.summary += fmt::format(" ({})", visible_words(json.at("licence").get<std::string>()));
    traits.by_default = false;
    if (std::ranges::find(k_runtimes, traits.runtime) == k_runtimes.end()) {
      throw BadArgument(fmt::format("runtime: \"{}\" is none of {}", traits.runtime, fmt::join(k_runtimes, ", ")));
    }
    return RemoteAlgorithm::described(std::move(traits), json.at("command").get<std::string>(), limits);
  } catch (const Json::exception& e) {
    throw BadFile(file.string(), e.what());
  } catch (const Error& e) {
    throw BadFile(file.string(), e.what());
  }
}

}  // namespace

std::filesystem::path rivals_folder() {
  if (const auto own = folder_of("SIXDOF_RIVALS"); !own.empty()) return own;
  if (const auto cache = folder_of("XDG_CACHE_HOME"); !cache.empty()) return cache / "sixdof-rivals";
  const auto home = folder_of("HOME");
  return home.empty() ? home : home / ".cache/sixdof-rivals";
}

std::vector<std::string> register_rivals(Registry& registry, const std::filesystem::path& folder,
                                         const ProcessLimits& limits, const std::set<std::string>& without) {
  std::vector<std::string> warnings;
  for (const std::filesystem::path& file : ready_files(folder)) {
    try {
      std::unique_ptr<Algorithm> rival = read_rival(file, limits);
      if (without.contains(rival->traits().name)) continue;
      registry.add(std::move(rival));
    } catch (const BadFile& e) {
      warnings.emplace_back(e.what());
    } catch (const BadArgument& e) {
      warnings.push_back(fmt::format("{}: {}", file.string(), e.what()));
    }
  }
  return warnings;
}

std::vector<std::string> rival_names(const Registry& registry) {
  std::vector<std::string> names;
  for (const auto& algorithm : registry.all()) {
    if (algorithm->traits().is_rival()) names.push_back(algorithm->traits().name);
  }
  return names;
}

std::vector<std::string> with_rivals(const std::vector<std::string>& names, const Registry& registry,
                                     const std::function<bool(const Traits&)>& suits) {
  std::vector<std::string> all;
  for (const std::string& name : names) {
    if (name != k_rivals) {
      all.push_back(name);
      continue;
    }
    const std::size_t before = all.size();
    for (const std::string& rival : rival_names(registry)) {
      if (!suits || suits(registry.find(rival).traits())) all.push_back(rival);
    }
    if (all.size() == before) {
      throw BadArgument("rivals: none that suits is set up (bench/rivals/setup)");
    }
  }
  return all;
}

}  // namespace sixdof
