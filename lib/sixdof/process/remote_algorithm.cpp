#include <sixdof/process/remote_algorithm.h>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>

namespace sixdof {

namespace {

/// The shell becomes the program, so that a signal that ends it is seen, and ends it.
RemoteProgram program_of(const std::string& command_line, const ProcessLimits& limits) {
  return remote_program({"/bin/sh", "-c", "exec " + command_line}, limits);
}

}  // namespace

std::unique_ptr<RemoteAlgorithm> RemoteAlgorithm::external(const std::string& name, const std::string& command_line,
                                                           const ProcessLimits& limits) {
  try {
    Traits traits = ask_greeting(program_of(command_line, limits)).traits;
    traits.name = name;
    if (traits.summary.empty()) traits.summary = visible_words(fmt::format("answers of {}", command_line));
    return described(std::move(traits), command_line, limits);
  } catch (const Error& e) {
    throw BadArgument(fmt::format("external algorithm {} ({}): {}", name, command_line, e.what()));
  }
}

std::unique_ptr<RemoteAlgorithm> RemoteAlgorithm::described(Traits traits, const std::string& command_line,
                                                            const ProcessLimits& limits) {
  if (!traits.answers.any()) throw BadArgument("answers no kind of query");
  static_cast<void>(Settings(traits.parameters));
  std::unique_ptr<RemoteAlgorithm> algorithm(new RemoteAlgorithm(std::move(traits), program_of(command_line, limits)));
  algorithm->command_line_ = command_line;
  return algorithm;
}

}  // namespace sixdof
