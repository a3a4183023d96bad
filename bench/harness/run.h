#pragma once

namespace sixdof::bench {

/// The whole of sixdof-bench: every algorithm of this build and every Registrar, every family of rows.
/// @returns the exit code: 0, 1 (nothing matched, a row could not be run, a file could not be read or written), 2
/// (command line), 130 (Ctrl-C: the file holds the rows that were finished, with "interrupted": "true" in its context).
int run(int argc, const char* const* argv);

}  // namespace sixdof::bench
