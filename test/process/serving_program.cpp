// A program that serves one algorithm: `exact`, one of those that die (deadly_query.h), one that is killed while it
// prepares, one that refuses the mesh, or one with parameters.

#include <csignal>
#include <memory>
#include <string>

#include <sixdof/base/error.h>
#include <sixdof/process/serve.h>

#include "deadly_query.h"

namespace {

using namespace sixdof;

struct DiesInPrepare final : Query {
  DiesInPrepare(const Mesh&, const Mesh&, const Settings&) { std::raise(SIGKILL); }
};

struct Refuses final : Query {
  Refuses(const Mesh& a, const Mesh&, const Settings&) { throw BadMesh(a.name() + ": too pretty"); }
};

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
  serve_on_standard_streams(*make(argv[1]));
  return 0;
}
