#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// The list of algorithms that benchmarks, tests, command line and report read. Filled explicitly: a static library
/// would drop objects that register themselves.
class Registry {
 public:
  /// @throws BadArgument if the name is taken or has characters other than a-z 0-9 '-'.
  void add(std::unique_ptr<Algorithm> algorithm);

  /// @throws BadArgument that lists the names there are.
  const Algorithm& find(std::string_view name) const;

  /// In the order of registration.
  const std::vector<std::unique_ptr<Algorithm>>& all() const { return algorithms_; }

 private:
  std::vector<std::unique_ptr<Algorithm>> algorithms_;
};

}  // namespace sixdof
