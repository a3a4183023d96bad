// sixdof-bench with `planted`: exact distances with one fault, which the environment names. For tests of `sixdof gate`
// and bench/scripts/gate-figures.
//
//   SIXDOF_PLANT=wrong:7         the distance at the 7th configuration that is asked is wrong, every time
//   SIXDOF_PLANT=lost:7          there is none
//   SIXDOF_PLANT=loops:1000      a query takes so many turns of an empty loop longer

#include <cstdlib>
#include <map>
#include <string>
#include <tuple>

#include <sixdof/oracle/distance.h>
#include <sixdof/query/registrar.h>

namespace {

using namespace sixdof;

/// Of A's diagonal: far above any tolerance of a bucket.
constexpr double k_wrong_by = 1e-3;

struct Plant {
  std::string kind;
  unsigned long number = 0;

  static Plant of_environment() {
    const char* const text = std::getenv("SIXDOF_PLANT");
    if (text == nullptr) return {};
    const std::string word = text;
    const std::size_t colon = word.find(':');
    return {word.substr(0, colon), std::stoul(word.substr(colon + 1))};
  }
};

class PlantedQuery final : public Query {
 public:
  PlantedQuery(const Mesh& a, const Mesh& b, const Settings&)
      : oracle_(a, b), query_(oracle_), wrong_by_(k_wrong_by * a.diagonal()) {}

  Outcome<Separation> distance(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    if (plant_.kind == "loops") {
      for (unsigned long i = 0; i < plant_.number; ++i) asm volatile("" : : "r"(i));
    }
    Separation separation = query_.distance(X_AB, false);
    if (plant_.kind != "wrong" && plant_.kind != "lost") return separation;
    const auto place = places_.try_emplace({X_AB.t.x(), X_AB.t.y(), X_AB.t.z()}, places_.size() + 1).first->second;
    if (place != plant_.number) return separation;
    if (plant_.kind == "lost") return fail(Status::failed, "planted");
    separation.distance += wrong_by_;
    return separation;
  }

 private:
  const Plant plant_ = Plant::of_environment();
  DistanceOracle oracle_;
  DistanceQuery query_;
  double wrong_by_;
  std::map<std::tuple<double, double, double>, std::size_t> places_;  ///< Of configurations, from 1 on, as asked first.
};

const Registrar k_planted([] {
  return make_algorithm<PlantedQuery>(
      {.name = "planted", .version = "1", .summary = "exact distances, with a fault", .answers = {.distance = true}});
});

}  // namespace
