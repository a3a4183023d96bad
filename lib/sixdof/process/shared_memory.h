#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace sixdof {

/// A file without a name, in memory, that a program started with its descriptor can open: nothing is left behind,
/// however the programs end.
class MemoryFile {
 public:
  /// @param name for messages of the system only @throws Error
  MemoryFile(const char* name, std::span<const std::byte> content);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }

  /// Another content in place of what is there. @throws Error
  void replace(std::span<const std::byte> content);

 private:
  const char* name_;
  int descriptor_ = -1;
};

/// Of a program that finds the descriptor under this number.
std::string path_of_descriptor(int number);

/// A number that two programs share: how many queries of a request one of them has begun.
class SharedCounter {
 public:
  /// @param descriptor of 8 bytes, which it does not take over @throws Error
  explicit SharedCounter(int descriptor);
  /// @throws BadFile
  explicit SharedCounter(const std::string& path);
  ~SharedCounter();
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;

  void set(std::uint64_t value) { std::atomic_ref(*value_).store(value, std::memory_order_relaxed); }
  std::uint64_t get() const { return std::atomic_ref(*value_).load(std::memory_order_relaxed); }

 private:
  void map(int descriptor, const std::string& name);
  std::uint64_t* value_ = nullptr;
};

}  // namespace sixdof
