#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// Adds an external algorithm to the programs. Link sixdof::bench_main or sixdof::cli_main and write at namespace scope
///
///     const sixdof::Registrar mine([] { return sixdof::make_algorithm<MyQuery>({.name = "mine", ...}); });
///
/// in a source file of the program itself (a linker drops unreferenced objects of static libraries). The program then
/// is sixdof-bench or sixdof with that algorithm in every row, command and study. README.md has the rules;
/// `sixdof new-algorithm` writes a project.
class Registrar {
 public:
  using Maker = std::function<std::unique_ptr<Algorithm>()>;
  explicit Registrar(Maker maker) { makers().push_back(std::move(maker)); }

  static std::vector<Maker>& makers() {
    static std::vector<Maker> list;
    return list;
  }
};

}  // namespace sixdof
