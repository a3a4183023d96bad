// A program that serves one algorithm: `exact`, one of those that die (deadly_query.h), one that is killed while it
// prepares, one that refuses the mesh, one with parameters, or one that says hostile texts.

#include <csignal>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include <sixdof/base/error.h>
#include <sixdof/process/serve.h>

#include "deadly_query.h"
#include "hostile_text.h"

namespace {

using namespace sixdof;

struct DiesInPrepare final : Query {
  DiesInPrepare(const Mesh&, const Mesh&, const Settings&) { std::raise(SIGKILL); }
};

struct Refuses final : Query {
  Refuses(const Mesh& a, const Mesh&, const Settings&) { throw BadMesh(a.name() + ": too pretty"); }
};

/// Throws the text of the pose's number.
struct Talkative final : Query {
  Talkative(const Mesh&, const Mesh&, const Settings&) {}
  Outcome<bool> collide(const Pose& X_AB) override {
    throw std::runtime_error(test::hostile_text(static_cast<std::uint64_t>(X_AB.t.x())));
  }
};

/// The same in JSON as only others write it.
void talk_json() {
  std::uint64_t asked = 0;
  for (std::string line; std::getline(std::cin, line);) {
    const std::string text = test::as_json_string(test::hostile_text(asked), asked);
    if (line.find("\"hello\"") != std::string::npos) {
      std::cout << R"({"protocol": 1, "name": "x", "version": "1", "answers": ["collide"], "summary": )" << text;
    } else if (line.find("\"prepare\"") != std::string::npos) {
      std::cout << R"({"prepared": true, "counts": {)" << text << ": 1}";
    } else {
      std::cout << R"({"status": "failed", "words": )" << text;
      ++asked;
    }
    std::cout << "}" << std::endl;
  }
}

/// The distance is a setting.
class Configured final : public Query {
 public:
  Configured(const Mesh&, const Mesh&, const Settings& settings)
      : distance_(settings.number("gap") + (settings.choice("mode") == "far" ? 100.0 : 0.0)) {}
  Outcome<bool> collide(const Pose&) override { throw std::runtime_error("no convergence"); }
  Outcome<Separation> distance(const Pose&) override {
    ++asked_;
    return Separation{.distance = distance_};
  }
  Footprint footprint() const override { return {.bytes = 123, .counts = {{"nodes", 7}, {"fill_a", 0.1}}}; }
  std::vector<Work> work() const override { return {{"points", asked_, 8.5}}; }

 private:
  double distance_, asked_ = 0.0;
};

std::unique_ptr<Algorithm> make(const std::string& name) {
  const QuerySet all{.collide = true, .distance = true, .respond = true};
  if (name == "exact") return make_exact_algorithm();
  if (name == "dies-in-prepare") return make_algorithm<DiesInPrepare>({.name = name, .version = "1", .answers = all});
  if (name == "talkative") return make_algorithm<Talkative>({.name = name, .version = "1", .answers = all});
  if (name == "refuses") return make_algorithm<Refuses>({.name = name, .version = "1", .answers = all});
  if (name == "configured") {
    return make_algorithm<Configured>({.name = name,
                                       .version = "2.5",
                                       .summary = "has parameters",
                                       .answers = {.collide = true, .distance = true},
                                       .law = ResponseLaw::depth,
                                       .parameters = {Parameter::number("gap", "of all", "1", "0.5", 0.0, 10.0),
                                                      Parameter::choice("mode", "where", "near", {"near", "far"})}});
  }
  for (const test::Death& death : test::deaths()) {
    if (name == death.name) return std::make_unique<test::DeadlyAlgorithm>(death);
  }
  throw BadArgument("no such algorithm: " + name);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  if (argv[1] == std::string("talks-json")) {
    talk_json();
    return 0;
  }
  serve_on_standard_streams(*make(argv[1]));
  return 0;
}
