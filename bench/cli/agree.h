#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <sixdof/query/registry.h>
#include "bench/common/process_options.h"
#include "bench/study/set_agreement.h"

/// What `sixdof agree` takes. It asks yes/no and distances (agree.cpp) or first contacts (agree_casts.cpp).

namespace sixdof::cli {

struct AgreeArguments {
  std::vector<std::string> pairs, sets, algorithms, parameters;
  std::string question = "pose";  ///< Or "cast".
  std::size_t sample = 100;
  std::uint64_t seed = 1;
  std::size_t show = 1;
  bool json = false;
  ProcessOptions process;
};

/// @throws DefectsFound if an answer is a fault
void agree_casts(const AgreeArguments& arguments);

}  // namespace sixdof::cli
