#include <sixdof/algorithm/core_algorithms.h>

#include <fmt/format.h>

#include <sixdof/algorithm/rotation_check.h>
#include <sixdof/base/parallel.h>
#include <sixdof/oracle/depth_integral.h>

namespace sixdof {
namespace {

constexpr double k_most_threads = 64.0;

template <DepthDirection k_direction>
class ExactDepthQuery final : public Query {
 public:
  ExactDepthQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : oracle_(a, b),
        tolerance_{.relative = settings.number("tolerance"),
                   .most_pieces = static_cast<std::size_t>(settings.number("most_pieces"))},
        threads_(static_cast<unsigned>(settings.number("threads"))) {}

  Outcome<Response> respond(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    if (!is_rotation(X_AB.R)) return fail(Status::failed, "the pose's matrix is not a rotation");
    DepthIntegral found;
    parallel::with_threads(threads_, [&] { found = oracle_.evaluate(X_AB, k_direction, tolerance_); });
    if (!found.converged) {
      return fail(Status::failed, fmt::format("{} pieces, and the error of the force may be {:.2g} of {:.3g}",
                                              found.pieces, found.force_error, found.force.norm()));
    }
    return Response{.penalty = found.depth, .force = found.force, .torque = found.torque, .reference = found.reference};
  }

  Footprint footprint() const override {
    const auto nodes = [](const Tree& tree) { return static_cast<double>(tree.nodes().size()); };
    return {oracle_.bytes(), {{"nodes_a", nodes(oracle_.tree_a())}, {"nodes_b", nodes(oracle_.tree_b())}}};
  }

 private:
  const DepthOracle oracle_;
  const DepthTolerance tolerance_;
  const unsigned threads_;
};

template <DepthDirection k_direction>
std::unique_ptr<Algorithm> make(const char* name, const char* summary, ResponseLaw law) {
  return make_algorithm<ExactDepthQuery<k_direction>>(
      {.name = name,
       .version = SIXDOF_VERSION,
       .summary = summary,
       .answers = {.respond = true},
       .law = law,
       // B's surface outside A carries nothing.
       .limits = {.surfaces_only = {.respond = true}, .own_direction = true, .points_of_b_only = true},
       .parameters = {Parameter::number("tolerance",
                                        "largest error of the force over the force, estimated; of the torque likewise",
                                        "1", "0.001", 1e-8, 0.5)
                          .swept({"0.1", "0.01", "0.001", "0.0001"}),
                      Parameter::count("most_pieces", "of B's triangles; a query that needs more fails", "400000", 1e3,
                                       1e8),
                      Parameter::count("threads", "that a response may use; changes no bit of it", "1", 1.0,
                                       k_most_threads)},
       .timed = k_direction == DepthDirection::normal_of_b,  // the other takes seconds where directions jump much
       .by_default = false});
}

}  // namespace

std::unique_ptr<Algorithm> make_exact_depth_algorithm() {
  return make<DepthDirection::normal_of_b>(
      "exact-depth", "integral of the exact depth along B's inward normals over its surface inside A: the limit of vps",
      ResponseLaw::depth);
}

std::unique_ptr<Algorithm> make_exact_way_out_algorithm() {
  return make<DepthDirection::way_out>(
      "exact-way-out",
      "integral of the exact depth along the way out over B's surface inside A: the limit of vps-field",
      ResponseLaw::way_out);
}

}  // namespace sixdof
