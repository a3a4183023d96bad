#include "bench/common/serve_algorithm.h"

#include <cstring>

#include <sixdof/process/serve.h>
#include "bench/common/all_algorithms.h"
#include "bench/common/run_guarded.h"

namespace sixdof {
namespace {

/// No option of any command.
constexpr const char* k_word = "--serve-algorithm";

}  // namespace

std::vector<std::string> serving_command(const std::string& algorithm) { return {"/proc/self/exe", k_word, algorithm}; }

std::optional<int> serve_if_asked(int argc, const char* const* argv) {
  if (argc != 3 || std::strcmp(argv[1], k_word) != 0) return std::nullopt;
  return run_guarded("sixdof", [&] {
    Registry registry;
    register_all_algorithms(registry, {.rivals = false});
    serve_on_standard_streams(registry.find(argv[2]));
  });
}

}  // namespace sixdof
