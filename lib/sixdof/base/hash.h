#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace sixdof {

/// Incremental 128-bit content hash (XXH3), the same on every machine of the same byte order.
/// Not cryptographic: it tells apart contents, it does not withstand forgery.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void add(std::span<const std::byte> bytes);

  template <class T>
  void add_values(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(std::as_bytes(values));
  }

  /// 32 lower-case hexadecimal digits.
  std::string hex() const;

 private:
  struct State;
  State* state_;
};

}  // namespace sixdof
