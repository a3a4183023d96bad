#include <sixdof/algorithm/core_algorithms.h>

#include <cstdint>

#include <fmt/format.h>

#include <sixdof/algorithm/rotation_check.h>
#include <sixdof/base/parallel.h>
#include <sixdof/oracle/distance.h>
#include <sixdof/oracle/penetration.h>

namespace sixdof {
namespace {

constexpr const char* k_tolerance = "tolerance";
constexpr const char* k_budget = "budget";
constexpr const char* k_threads = "threads";
constexpr double k_most_threads = 64.0;

class ExactPenetrationQuery final : public Query {
 public:
  ExactPenetrationQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : oracle_(a, b), distance_(oracle_.distance_oracle()) {
    options_.tolerance = settings.number(k_tolerance);
    options_.budget = static_cast<std::uint64_t>(settings.number(k_budget));
    threads_ = static_cast<unsigned>(settings.number(k_threads));
  }

  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override {
    if (!is_finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    if (!is_rotation(X_AB.R)) return fail(Status::failed, "the pose's matrix is not a rotation");
    PenetrationDepth found;
    parallel::with_threads(threads_, [&] { found = oracle_.evaluate(X_AB, options_); });
    work_ = {.unit = "cells", .tested = static_cast<double>(found.cells), .total = static_cast<double>(found.cells)};
    if (!found.closed) {
      return fail(Status::failed, fmt::format("the depth is open: {} to {}", found.lo, found.hi));
    }
    const double length = found.translation.norm();
    if (most == 0 || !(length > 0.0)) return Contacts{};
    // Where the bodies are in contact after the translation.
    const Separation touch = distance_.distance({X_AB.R, X_AB.t + found.translation}, false);
    return Contacts{{{.point = touch.witness_a, .normal = found.translation / length, .depth = found.hi}}};
  }

  Footprint footprint() const override { return {oracle_.distance_oracle().bytes(), {}}; }
  std::vector<Work> work() const override { return {work_}; }

 private:
  PenetrationOracle oracle_;
  DistanceQuery distance_;
  PenetrationOptions options_;
  unsigned threads_ = 1;
  Work work_{.unit = "cells"};
};

}  // namespace

std::unique_ptr<Algorithm> make_exact_penetration_algorithm() {
  return make_algorithm<ExactPenetrationQuery>(
      {.name = "exact-penetration",
       .version = SIXDOF_VERSION,
       .summary = "one contact: the shortest translation by which B leaves A, proven to a tolerance",
       .answers = {.contacts = true},
       .depth = ContactDepth::bodies,
       .parameters = {Parameter::number(k_tolerance, "width of the interval of the depth, by its upper end", "1",
                                        "1e-3", 1e-9, 0.5),
                      Parameter::count(k_budget, "points and cells after which there is no answer", "400000", 1, 1e9),
                      Parameter::count(k_threads, "that a query may use; changes no bit of it", "1", 1.0,
                                       k_most_threads)},
       .by_default = false});
}

}  // namespace sixdof
