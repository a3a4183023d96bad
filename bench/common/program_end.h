#pragma once

#include <string_view>

/// What a program says as it ends.

namespace sixdof {

/// Flushes standard output. @return 0, or k_exit_error after a message if any of it could not be written
int end_output(std::string_view program);

/// Prints why the cache was not used, if it was refused (base/cache.h).
void print_cache_refusal(std::string_view program);

}  // namespace sixdof
