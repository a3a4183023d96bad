#include <sixdof/algorithm/null.h>

namespace sixdof {
namespace {

class NullQuery final : public Query {
 public:
  NullQuery(const Mesh&, const Mesh&, const Settings&) {}
  Outcome<bool> collide(const Pose&) override { return false; }
  Outcome<Separation> distance(const Pose&) override { return Separation{}; }
  Outcome<Response> respond(const Pose&) override { return Response{}; }
};

}  // namespace

std::unique_ptr<Algorithm> make_null_algorithm() {
  return make_algorithm<NullQuery>({.name = "null",
                                    .version = SIXDOF_VERSION,
                                    .summary = "answers with constants: its time is the overhead of the benchmarks",
                                    .answers = {.collide = true, .distance = true, .respond = true}});
}

}  // namespace sixdof
