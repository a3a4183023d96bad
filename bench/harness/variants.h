#pragma once

#include <string>
#include <vector>

#include <sixdof/query/registry.h>

/// Several settings of one algorithm in one run.

namespace sixdof::bench {

/// An algorithm with settings that differ from its defaults.
struct VariantRequest {
  std::string algorithm;                 ///< As in the registry.
  std::vector<std::string> assignments;  ///< Each reads "parameter=value".
};

/// Takes the lists of values out of a command line's parameters. "vps:point_spacing=0.004,0.008" puts two variants
/// (sixdof/query/variant.h) in the place of `vps`; lists for two parameters of one algorithm make every combination;
/// "rivals" stands for all rivals that have the parameter. Parameters of one value apply to all variants.
/// @param parameters "ALGORITHM:NAME=VALUE" or "ALGORITHM:NAME=VALUE,VALUE"
/// @param further variants besides the algorithm, which stays; requests for algorithms that are not there are ignored
/// @returns the parameters of one value
/// @throws BadArgument for an algorithm, a parameter or a value that does not exist, or the same value twice
std::vector<std::string> register_variants(const std::vector<std::string>& parameters,
                                           const std::vector<VariantRequest>& further, Registry& registry);

}  // namespace sixdof::bench
