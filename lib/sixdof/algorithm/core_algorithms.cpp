#include <sixdof/algorithm/core_algorithms.h>

#include <sixdof/algorithm/ist/ist.h>
#include <sixdof/algorithm/vps/vps.h>

namespace sixdof {
namespace {

/// `null`: its answers are wrong on purpose.
class NullQuery final : public Query {
 public:
  NullQuery(const Mesh&, const Mesh&, const Settings&) {}
  Outcome<bool> collide(const Pose&) override { return false; }
  Outcome<Separation> distance(const Pose&) override { return Separation{}; }
  Outcome<Response> respond(const Pose&) override { return Response{}; }
  Outcome<Impact> cast(const Motion&) override { return Impact{}; }
  Outcome<Contacts> contacts(const Pose&, std::size_t) override { return Contacts{}; }
};

}  // namespace

void register_core_algorithms(Registry& registry) {
  registry.add(make_algorithm<NullQuery>(
      {.name = "null",
       .version = SIXDOF_VERSION,
       .summary = "answers with constants: its time is the overhead of the benchmarks",
       .answers = {.collide = true, .distance = true, .respond = true, .cast = true, .contacts = true}}));
  registry.add(make_brute_force_algorithm());
  registry.add(make_exact_algorithm());
  registry.add(make_sampled_algorithm());
  registry.add(make_exact_contacts_algorithm());
  registry.add(make_exact_depth_algorithm());
  registry.add(make_exact_way_out_algorithm());
  registry.add(make_exact_penetration_algorithm());
  registry.add(make_ist_algorithm());
  registry.add(make_ist_descent_algorithm());
  registry.add(make_vps_algorithm());
  registry.add(make_vps_field_algorithm());
}

}  // namespace sixdof
