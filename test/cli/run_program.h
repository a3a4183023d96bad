#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace sixdof::test {

/// What a program left behind. `exit_code` is 128 + signal where a signal ended it, as shells have it.
struct ProgramResult {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Runs a shell command line to its end.
inline ProgramResult run_program(const std::string& command) {
  static int counter = 0;
  const auto error_file = std::filesystem::temp_directory_path() /
                          ("sixdof-test-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".err");
  ProgramResult result;
  std::FILE* const pipe = ::popen(("{ " + command + "; } 2>" + error_file.string()).c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("popen failed");
  std::array<char, 4096> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    result.out.append(block.data(), n);
  const int status = ::pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  std::ostringstream text;
  text << std::ifstream(error_file).rdbuf();
  result.err = text.str();
  std::filesystem::remove(error_file);
  return result;
}

}  // namespace sixdof::test
