#pragma once

#include <sixdof/query/algorithm.h>

namespace sixdof {

/// The process of an isolated algorithm: answers the requests of the protocol (protocol.h) with one algorithm until the
/// input ends. Exceptions and NaN become a Status as in ask.h; what ends the process is for the other side to see.
///
/// @param input, output descriptors of the lines; both stay open
void serve(const Algorithm& algorithm, int input, int output);

/// The same over this program's standard input and output. What the algorithm's library reads from standard input is
/// empty, and what it prints on standard output goes to standard error.
void serve_on_standard_streams(const Algorithm& algorithm);

}  // namespace sixdof
