#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <sixdof/query/algorithm.h>

namespace sixdof::bench {

/// How a program of yours adds its algorithm to the suite. Link sixdof::bench_main and write at namespace scope
///
///     const sixdof::bench::Registrar mine([] { return std::make_unique<MyAlgorithm>(); });
///
/// in a source file of the program itself (a linker drops unreferenced objects of static libraries). The program then
/// is a sixdof-bench with one algorithm more.
class Registrar {
 public:
  using Maker = std::function<std::unique_ptr<Algorithm>()>;
  explicit Registrar(Maker maker) { makers().push_back(std::move(maker)); }

  static std::vector<Maker>& makers() {
    static std::vector<Maker> list;
    return list;
  }
};

}  // namespace sixdof::bench
