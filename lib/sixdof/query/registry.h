#pragma once

#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// The algorithms that a program knows. Filled explicitly: a linker drops the objects of a static library that would
/// register themselves.
class Registry {
 public:
  /// @throws BadArgument if it is null, a name is taken or has characters other than a-z 0-9 '-' (of parameters '_'), a
  /// value cannot be typed and recorded, or the sweeps of two parameters have unlike numbers of values
  void add(std::unique_ptr<Algorithm> algorithm);

  /// @throws BadArgument that lists the registered names
  const Algorithm& find(std::string_view name) const;

  /// All algorithms in the order in which they were added; none is null.
  const std::vector<std::unique_ptr<Algorithm>>& all() const { return algorithms_; }

  /// All algorithms; leaves none.
  std::vector<std::unique_ptr<Algorithm>> take() { return std::exchange(algorithms_, {}); }

 private:
  std::vector<std::unique_ptr<Algorithm>> algorithms_;
};

}  // namespace sixdof
