#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sixdof {

/// The positions of the set bits of every number below 256, ascending; zeros after them. For SIMD code that appends
/// some lanes of a vector to a list. Highway's Compress() does so in one call, but GCC 12 copies the table that it
/// looks up to the stack each time, which takes longer than all else around it.
inline constexpr std::array<std::array<std::uint8_t, 8>, 256> k_set_bits = [] {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (std::size_t number = 0; number < 256; ++number) {
    std::size_t count = 0;
    for (std::size_t bit = 0; bit < 8; ++bit) {
      if ((number >> bit & 1) != 0) table[number][count++] = static_cast<std::uint8_t>(bit);
    }
  }
  return table;
}();

}  // namespace sixdof
