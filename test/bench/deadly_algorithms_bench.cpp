// sixdof-bench with algorithms that end, or stop, their process at one pose in 20 (../process/deadly_query.h), one that
// always does, one that dies while it prepares, and one whose queries take the same work each.

#include <csignal>
#include <cstdint>

#include <sixdof/query/registrar.h>

#include "../process/deadly_query.h"

namespace {

using namespace sixdof;

/// Some 20 microseconds.
class FixedWork final : public Query {
 public:
  FixedWork(const Mesh&, const Mesh&, const Settings&) {}
  Outcome<Separation> distance(const Pose& X_AB) override {
    constexpr int k_steps = 20'000;
    std::uint64_t state = static_cast<std::uint64_t>(X_AB.t.x() > 0.0);
    for (int i = 0; i < k_steps; ++i) state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return Separation{.distance = static_cast<double>(state >> 63)};
  }
};

struct AlwaysDies final : Query {
  AlwaysDies(const Mesh&, const Mesh&, const Settings&) {}
  Outcome<Separation> distance(const Pose&) override { std::abort(); }
};

struct DiesInPrepare final : Query {
  DiesInPrepare(const Mesh&, const Mesh&, const Settings&) { std::raise(SIGSEGV); }
};

template <class QueryType>
Registrar add(const char* name) {
  return Registrar([name] {
    return make_algorithm<QueryType>(
        {.name = name, .version = "1", .summary = "for tests", .answers = {.distance = true}});
  });
}

const Registrar k_others[] = {add<FixedWork>("fixed-work"), add<AlwaysDies>("always-dies"),
                              add<DiesInPrepare>("dies-in-prepare")};

const std::vector<Registrar> k_deadly = [] {
  std::vector<Registrar> list;
  for (const test::Death& death : test::deaths()) {
    list.emplace_back([&death] { return std::make_unique<test::DeadlyAlgorithm>(death); });
  }
  return list;
}();

}  // namespace
