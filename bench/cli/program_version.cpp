#include "bench/cli/program_version.h"

#include <string_view>

#include <fmt/format.h>

#include "sixdof_commit.h"

namespace sixdof::cli {

std::string program_version() {
  constexpr std::size_t k_digits = 12;
  return fmt::format("{} {}{}", SIXDOF_VERSION, std::string_view(k_commit).substr(0, k_digits),
                     k_commit_dirty ? " (modified)" : "");
}

}  // namespace sixdof::cli
