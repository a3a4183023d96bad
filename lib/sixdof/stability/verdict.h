#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sixdof::stability {

/// How an algorithm did, from best to worst.
enum class Verdict {
  exact,          ///< Right to rounding (Shot::rounding()).
  resolution,     ///< Within what the algorithm declares, or k_declared_accuracy.
  unsupported,    ///< Declared: it answers no such query, or refuses a mesh that is not solid.
  wrong,          ///< An answer that is off by more, or contradicts another one.
  non_finite,     ///< A NaN or an infinity.
  threw,          ///< It gave up with words.
  out_of_memory,  ///< In a process of its own.
  hung,           ///< No answer within the time limit.
  crashed,        ///< The process ended.
};

constexpr std::string_view to_string(Verdict verdict) {
  constexpr std::string_view k_names[] = {"exact",
                                          "within declared resolution",
                                          "declared unsupported",
                                          "wrong",
                                          "non-finite",
                                          "threw",
                                          "out of memory",
                                          "hung",
                                          "crashed"};
  return k_names[static_cast<std::size_t>(verdict)];
}

/// Whether the verdict is a failure: a wrong answer, or none.
constexpr bool is_red(Verdict verdict) { return verdict > Verdict::unsupported; }

/// Errors of lengths up to this fraction of A's diagonal are allowed to every algorithm, as in rows of benchmarks.
inline constexpr double k_declared_accuracy = 1e-9;

/// One thing that was measured.
struct Finding {
  Verdict verdict = Verdict::exact;
  std::string metric;    ///< "distance", "scale", "missed", ...
  double value = 0.0;    ///< In `unit`.
  std::string unit;      ///< "size": fractions of A's diagonal; "volume": of its cube; "rad", "1".
  double excess = 0.0;   ///< Error over the error that rounding explains: what a search maximises.
  std::size_t shot = 0;  ///< Of the case.
  std::string words;     ///< What was expected, or what the algorithm said.

  /// A worse verdict first, then a larger excess.
  bool worse_than(const Finding& other) const {
    return verdict != other.verdict ? verdict > other.verdict : excess > other.excess;
  }
};

}  // namespace sixdof::stability
