#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace sixdof {

/// The value of type T stored at `at` in the given byte order; `at` need not be aligned.
template <class T>
T load_bytes(const char* at, std::endian order) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), at, sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

template <class T>
T load_little_endian(const char* at) {
  return load_bytes<T>(at, std::endian::little);
}

/// Appends the bytes of `value`, lowest first.
template <class T>
void append_little_endian(std::string& bytes, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native != std::endian::little) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

}  // namespace sixdof
