#pragma once

#include <span>
#include <string_view>

namespace sixdof {

/// Which way a measure gets better.
enum class Better {
  lower,       ///< The nearer to zero the better.
  higher,      ///< The larger the better.
  nearer_one,  ///< A ratio that should be 1.
  neither,     ///< Describes, does not judge.
};

std::string_view to_string(Better better);

/// One measure of a response benchmark's row. `_F` and `_T` mean force and torque; the suffix "_all", not listed here,
/// means the whole path where the plain name is over the scenario's window, and "_by_" with a law's name that the ideal
/// is that law's and not the one the algorithm declares.
struct Metric {
  std::string_view name;  ///< Counter in the results, API.
  std::string_view unit;  ///< "1" for pure numbers.
  Better better;
  std::string_view meaning;  ///< One sentence.
  std::string_view source;   ///< Where the formula is from.
};

/// The one table of measures, read by recorder, benchmark rows, command line and report.
std::span<const Metric> metrics();

/// @throws BadArgument if there is no measure of that name; suffixes "_all" and "_by_LAW" are looked through.
const Metric& metric(std::string_view name);

}  // namespace sixdof
