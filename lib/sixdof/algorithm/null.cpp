#include <sixdof/algorithm/null.h>

namespace sixdof {
namespace {

class NullQuery final : public Query {
 public:
  Outcome<bool> collide(const Pose&) override { return false; }
  Outcome<Separation> distance(const Pose&) override { return Separation{}; }
  Outcome<Response> respond(const Pose&) override { return Response{}; }
};

class NullAlgorithm final : public Algorithm {
 public:
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh&, const Mesh&, const Settings&) const override {
    return std::make_unique<NullQuery>();
  }

 private:
  Traits traits_{.name = "null",
                 .version = SIXDOF_VERSION,
                 .summary = "answers nothing, costs nothing: shows the harness's own overhead",
                 .answers = {.collide = true, .distance = true, .respond = true},
                 .law = ResponseLaw::none,
                 .parameters = {}};
};

}  // namespace

std::unique_ptr<Algorithm> make_null_algorithm() { return std::make_unique<NullAlgorithm>(); }

}  // namespace sixdof
