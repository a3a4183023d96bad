#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

struct XXH3_state_s;

namespace sixdof {

/// Incremental 128-bit content hash (XXH3), the same on every machine of the same byte order. Not cryptographic.
class ContentHash {
 public:
  ContentHash();

  void add(std::span<const std::byte> bytes);

  template <class T>
  void add_values(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(std::as_bytes(values));
  }

  /// 32 lower-case hexadecimal digits.
  std::string hex() const;

 private:
  std::unique_ptr<XXH3_state_s, void (*)(XXH3_state_s*)> state_;
};

}  // namespace sixdof
