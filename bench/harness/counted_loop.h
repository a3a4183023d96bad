#pragma once

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#endif

namespace sixdof::bench {

/// While one lives, callgrind counts instructions, if the program runs in it with --instr-atstart=no
/// (bench/scripts/gate_instructions.py). Otherwise it does nothing that takes time. Where valgrind's header was not
/// there when this was compiled, nothing is ever counted.
class CountedLoop {
 public:
#ifdef CALLGRIND_START_INSTRUMENTATION
  CountedLoop() { CALLGRIND_START_INSTRUMENTATION; }
  ~CountedLoop() { CALLGRIND_STOP_INSTRUMENTATION; }
#else
  CountedLoop() {}
  ~CountedLoop() {}
#endif
  CountedLoop(const CountedLoop&) = delete;
  CountedLoop& operator=(const CountedLoop&) = delete;
};

}  // namespace sixdof::bench
