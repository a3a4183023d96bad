#include "bench/common/program_end.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/cache.h>
#include "bench/common/run_guarded.h"

namespace sixdof {

int end_output(std::string_view program) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  print_message(program, fmt::format("standard output: {}", std::strerror(errno)));
  return k_exit_error;
}

void print_cache_refusal(std::string_view program) {
  if (const std::string words = cache_refusal(); !words.empty()) print_message(program, words);
}

}  // namespace sixdof
