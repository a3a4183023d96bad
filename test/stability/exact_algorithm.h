#pragma once

#include <memory>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/stability/judge.h>

/// The reference, ready to be judged.
namespace sixdof::stability {

inline const Algorithm& exact_algorithm() {
  static const std::unique_ptr<Algorithm> algorithm = make_exact_algorithm();
  return *algorithm;
}

inline std::unique_ptr<Query> prepare_exact(const Mesh& a, const Mesh& b) {
  return exact_algorithm().prepare(a, b, exact_algorithm().settings());
}

inline const Traits& exact_traits() { return exact_algorithm().traits(); }

}  // namespace sixdof::stability
