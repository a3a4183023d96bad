#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/query/algorithm.h>

/// What `sixdof verify` takes. It measures poses, makes them again (verify.cpp), or checks the first contacts of
/// motions that begin at them (verify_motions.cpp).

namespace sixdof::cli {

struct VerifyArguments {
  std::string file, a, b;
  std::string oracle = "fcl-obbrss";
  std::size_t sample = 50;
  std::uint64_t seed = 1;
  std::string again;        // A count or "all"; empty: not given.
  std::size_t motions = 0;  // Of each kind and step; 0: not given.
  bool json = false;
};

/// Prints a line for each kind of motion and step. @throws Error if a truth has a problem; BadArgument if the set has
/// no poses of contact
void verify_motions(const VerifyArguments& arguments, const ConfigurationSet& set, const Mesh& a, const Mesh& b,
                    const Algorithm& oracle);

}  // namespace sixdof::cli
