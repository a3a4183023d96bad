#pragma once

#include <memory>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// `null`: answers every query at once with a constant (apart, no force). Its time is the harness's own overhead; its
/// answers are wrong on purpose wherever the bodies touch.
std::unique_ptr<Algorithm> make_null_algorithm();

}  // namespace sixdof
