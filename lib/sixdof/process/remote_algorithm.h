#pragma once

#include <memory>
#include <string>

#include <sixdof/process/remote_query.h>
#include <sixdof/query/algorithm.h>
#include <sixdof/query/variant.h>

namespace sixdof {

/// An algorithm whose queries run in processes of their own, one for each prepared pair.
class RemoteAlgorithm final : public Algorithm {
 public:
  /// An algorithm of this program, in the process of a program that serves it (serve.h).
  RemoteAlgorithm(std::unique_ptr<Algorithm> local, RemoteProgram program)
      : traits_(local->traits()), local_(std::move(local)), program_(std::move(program)) {}

  /// One that answers the protocol in any language. Starts the program to ask what it is.
  /// @param name as typed; the program's own name stands in messages only
  /// @param command_line one program with its arguments, for a shell: "python3 my.py"
  /// @throws BadArgument if the program does not answer as it should
  static std::unique_ptr<RemoteAlgorithm> external(const std::string& name, const std::string& command_line,
                                                   const ProcessLimits& limits);

  /// The same, where it is known what the program says of itself: starts no program.
  /// @throws BadArgument if it answers nothing, or for parameters that no Settings can have
  static std::unique_ptr<RemoteAlgorithm> described(Traits traits, const std::string& command_line,
                                                    const ProcessLimits& limits);

  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
    return std::make_unique<RemoteQuery>(program_, traits_, a, b, settings);
  }

  /// The algorithm in this process; null for an external one.
  const Algorithm* local() const { return local_.get(); }

  const ProcessLimits& limits() const { return program_.limits; }

  /// The command line of an external one; empty for others.
  const std::string& command_line() const { return command_line_; }

 private:
  RemoteAlgorithm(Traits traits, RemoteProgram program) : traits_(std::move(traits)), program_(std::move(program)) {}

  Traits traits_;
  std::unique_ptr<Algorithm> local_;
  RemoteProgram program_;
  std::string command_line_;
};

/// Whether the queries of an algorithm run in processes of their own.
inline bool is_isolated(const Algorithm& algorithm) {
  return dynamic_cast<const RemoteAlgorithm*>(&base_algorithm(algorithm)) != nullptr;
}

/// The same algorithm in this process, where it can be: for work that asks too often to wait for another process.
inline const Algorithm& in_this_process(const Algorithm& algorithm) {
  const auto* const remote = dynamic_cast<const RemoteAlgorithm*>(&base_algorithm(algorithm));
  return remote != nullptr && remote->local() != nullptr ? *remote->local() : algorithm;
}

/// Null for a query in this process.
inline RemoteQuery* as_remote(Query& query) { return dynamic_cast<RemoteQuery*>(&query); }

}  // namespace sixdof
