#include "bench/harness/run.h"

int main(int argc, char** argv) { return sixdof::bench::run(argc, argv); }
