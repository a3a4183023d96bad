#pragma once

#include <cstddef>
#include <vector>

#include <sys/types.h>

namespace sixdof {

/// A program that is to be started.
struct KeptProgram {
  char* const* words;  ///< Program and arguments, behind them a null pointer; the program is looked for in PATH.
  int input, output;   ///< What it finds as its standard streams.
  const std::vector<int>& files;  ///< What it finds as descriptors 3, 4, ...
  std::size_t memory_bytes;       ///< Most data; see limit_resources().
};

/// Exit code of a shell, and of what follows, for a program that cannot be started.
inline constexpr int k_not_started = 127;

/// Starts a program as the child of a process of its own, the keeper. The keeper is the reaper of the program's orphans
/// (PR_SET_CHILD_SUBREAPER), also of those that have left its process group and session. When the program ends, the
/// keeper kills all of its descendants that are left, and ends as the program did: by the same exit code or signal. At
/// SIGTERM, or when the calling thread ends (PR_SET_PDEATHSIG), it kills the program, too. It touches no other children
/// of the caller. It shares no descriptor, and little memory, with the caller.
/// @returns the keeper, leader of a process group; -1 with errno if there can be none
pid_t start_kept(const KeptProgram& program);

}  // namespace sixdof
