#include <filesystem>

#include <sixdof/bench/cli/commands.h>

#include "small_suite.h"

int main(int argc, char** argv) {
  return sixdof::cli::run_guarded("make_small_suite", [&] {
    if (argc == 2) sixdof::test::SmallSuite::make(argv[1]);
  });
}
