#include <sixdof/algorithm/algorithm_source.h>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof {
namespace {

class AlgorithmProbe final : public DistanceProbe {
 public:
  AlgorithmProbe(const std::string& name, std::unique_ptr<Query> query) : name_(name), query_(std::move(query)) {}

  ProbedDistance measure(const Pose& X_AB) override {
    const Outcome<Separation> answer = query_->distance(X_AB);
    if (!answer.ok()) {
      throw Error(fmt::format("{}: distance {}: {}", name_, to_string(answer.status), query_->diagnosis()));
    }
    return {.distance = answer.value.distance,
            .has_witnesses = answer.value.has_witnesses,
            .on_a = answer.value.witness_a,
            .on_b = answer.value.witness_b};
  }

 private:
  const std::string& name_;
  std::unique_ptr<Query> query_;
};

class AlgorithmSource final : public DistanceSource {
 public:
  explicit AlgorithmSource(const Algorithm& algorithm) : algorithm_(algorithm) {}
  const std::string& name() const override { return algorithm_.traits().name; }
  const std::string& version() const override { return algorithm_.traits().version; }
  std::unique_ptr<DistanceProbe> prepare(const Mesh& a, const Mesh& b) const override {
    return std::make_unique<AlgorithmProbe>(name(), algorithm_.prepare(a, b, algorithm_.settings()));
  }

 private:
  const Algorithm& algorithm_;
};

}  // namespace

std::shared_ptr<const DistanceSource> make_distance_source(const Algorithm& algorithm) {
  if (!algorithm.traits().answers.distance) {
    throw BadArgument(fmt::format("algorithm {}: answers no distance queries", algorithm.traits().name));
  }
  return std::make_shared<AlgorithmSource>(algorithm);
}

}  // namespace sixdof
