#include <sixdof/process/remote_algorithm.h>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {

std::unique_ptr<RemoteAlgorithm> RemoteAlgorithm::external(const std::string& name, const std::string& command_line,
                                                           const ProcessLimits& limits) {
  // The shell becomes the program, so that a signal that ends it is seen, and ends it.
  RemoteProgram program{{"/bin/sh", "-c", "exec " + command_line}, limits};
  try {
    Traits traits = ask_greeting(program).traits;
    traits.name = name;
    const QuerySet& answers = traits.answers;
    if (!answers.collide && !answers.distance && !answers.respond) throw Error("answers no kind of query");
    static_cast<void>(Settings(traits.parameters));
    std::unique_ptr<RemoteAlgorithm> algorithm(new RemoteAlgorithm(std::move(traits), std::move(program)));
    algorithm->command_line_ = command_line;
    return algorithm;
  } catch (const Error& e) {
    throw BadArgument(fmt::format("external algorithm {} ({}): {}", name, command_line, e.what()));
  }
}

}  // namespace sixdof
