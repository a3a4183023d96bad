#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <sixdof/process/remote_query.h>
#include <sixdof/query/registry.h>

/// Rivals: the libraries that bench/rivals/setup has made ready, each a program that answers the protocol of
/// lib/sixdof/process. A file of each has what its program says of itself, so that no program is started before it is
/// asked about a pair.

namespace sixdof {

/// Stands for all rivals in a list of algorithms.
inline constexpr const char* k_rivals = "rivals";

/// $SIXDOF_RIVALS; else $XDG_CACHE_HOME/sixdof-rivals; else $HOME/.cache/sixdof-rivals; empty without any of the three.
std::filesystem::path rivals_folder();

/// Adds an algorithm for each file ready/*.json of a folder, in the order of their names.
/// @param without names that are left out
/// @return for each file that cannot be used "FILE: CAUSE"
std::vector<std::string> register_rivals(Registry& registry, const std::filesystem::path& folder,
                                         const ProcessLimits& limits, const std::set<std::string>& without = {});

/// Names of the rivals of a registry.
std::vector<std::string> rival_names(const Registry& registry);

/// A list of algorithms with the names of rivals in place of k_rivals.
/// @param suits which rivals are meant; all without it
/// @throws BadArgument where k_rivals is in the list and none suits
std::vector<std::string> with_rivals(const std::vector<std::string>& names, const Registry& registry,
                                     const std::function<bool(const Traits&)>& suits = {});

}  // namespace sixdof
