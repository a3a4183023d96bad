#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <sixdof/stability/case.h>
#include <sixdof/stability/draw.h>

/// The families of hard cases. A family sweeps one quantity in which collision libraries are known to fail.
namespace sixdof::stability {

struct Family {
  int number;
  std::string_view name;                         ///< a-z and '-'.
  std::string_view sentence;                     ///< What is asked, in one line.
  std::string_view parameter;                    ///< What is swept, with its range.
  Case (*make)(Draw& draw);                      ///< The first gene is the parameter.
  std::vector<Case> (*field_cases)() = nullptr;  ///< Those that users met, rebuilt from the threads' numbers.
};

/// All, by number.
std::span<const Family> families();

/// @throws BadArgument that lists the names
const Family& find_family(std::string_view name);

/// The case of one sample; a number for every family, seed and index.
Genes sample_genes(const Family& family, std::uint64_t seed, std::size_t index, std::size_t count);

}  // namespace sixdof::stability
