#pragma once

#include <cstdint>

namespace sixdof {

/// A triangle of mesh A and one of mesh B: indices in the order of each mesh's Tree unless stated otherwise.
struct TrianglePair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

}  // namespace sixdof
