#pragma once

#include <memory>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// `null`: answers every query with a constant (no collision, distance 0, no force). Its time is the overhead of the
/// benchmarks; its answers are wrong on purpose.
std::unique_ptr<Algorithm> make_null_algorithm();

}  // namespace sixdof
