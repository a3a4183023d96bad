#pragma once

#include <string>
#include <string_view>

namespace sixdof {

/// Seconds of "90s", "10min", "0.9ms", "2h", "800us", "50ns". @throws BadArgument, naming `option`, for another text, a
/// missing unit, or a time that is not positive
double parse_duration(std::string_view option, const std::string& text);

/// Seconds as a person reads them: "0.9 ms", "12 us", "35 s", "2.5 min".
std::string duration_text(double seconds);

}  // namespace sixdof
