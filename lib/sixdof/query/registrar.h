#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// Wraps an algorithm: its version, descriptions and errors of prepare() are escaped (base/visible_text.h). Queries are
/// not wrapped. Null stays null.
std::unique_ptr<Algorithm> with_visible_words(std::unique_ptr<Algorithm> algorithm);

/// Adds an external algorithm to the programs. Link sixdof::bench_main or sixdof::cli_main and write at namespace scope
///
///     const sixdof::Registrar mine([] { return sixdof::make_algorithm<MyQuery>({.name = "mine", ...}); });
///
/// in a source file of the program itself (a linker drops unreferenced objects of static libraries). The program then
/// is sixdof-bench or sixdof with that algorithm in every row, command and study. README.md has the rules;
/// `sixdof new-algorithm` writes a project.
class Registrar {
 public:
  /// Makes the algorithm, each time when a registry is filled.
  using Maker = std::function<std::unique_ptr<Algorithm>()>;
  /// Keeps the maker for makers().
  explicit Registrar(Maker maker) {
    makers().push_back([maker = std::move(maker)] { return with_visible_words(maker()); });
  }

  /// Those of all Registrars of the program, in the order of their construction.
  static std::vector<Maker>& makers() {
    static std::vector<Maker> list;
    return list;
  }
};

}  // namespace sixdof
