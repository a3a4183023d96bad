#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sixdof {

/// What was written to a file, in order, so that all of it can be compared with what the file holds at the end: a disk
/// may say that a write was done which was not.
class WriteLog {
 public:
  /// Of longer writes only a hash is kept. One that a later write covers in part is not compared then.
  static constexpr std::size_t k_longest_kept = 65536;

  void add(std::uint64_t at, std::span<const std::byte> bytes);

  /// Whether the file holds the bytes that were written last, wherever they are within its size.
  bool matches(int descriptor) const;

 private:
  struct Write {
    std::uint64_t at;
    std::size_t size;
    std::string kept;  ///< The bytes, or their hash.
  };
  std::vector<Write> writes_;
};

}  // namespace sixdof
