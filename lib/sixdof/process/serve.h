#pragma once

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// Answers the requests of the protocol (protocol.h) with one algorithm until the input ends: the process of an
/// isolated algorithm. Exceptions and NaN become a Status as in ask.h; a crash is detected by the other side.
///
/// @param input, output descriptors of the lines; both stay open
void serve(const Algorithm& algorithm, int input, int output);

/// The same over this program's standard input and output. What the algorithm's library reads from standard input is
/// empty, and what it prints on standard output goes to standard error.
void serve_on_standard_streams(const Algorithm& algorithm);

}  // namespace sixdof
