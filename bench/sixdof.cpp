#include "bench/cli/commands.h"

int main(int argc, char** argv) { return sixdof::cli::run(argc, argv); }
