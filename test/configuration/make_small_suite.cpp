#include <cstdio>
#include <exception>

#include "small_suite.h"

int main(int argc, char** argv) {
  try {
    if (argc == 2) sixdof::test::SmallSuite::make(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "make_small_suite: %s\n", e.what());
    return 1;
  }
}
