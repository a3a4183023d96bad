#include <sixdof/scene/truth.h>

#include <fmt/format.h>

#include <sixdof/base/cache.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>
#include <sixdof/scene/all_pairs.h>

namespace sixdof::scene {
namespace {

constexpr const char* k_kind = "scene-truth";

std::string key_of(const Scene& scene, Question question) {
  return fmt::format("version {} scene {} question {}", k_truth_version, scene.hash(), to_string(question));
}

CacheEntry pack(const SceneAnswers& truth) {
  std::vector<std::uint64_t> pair_start{0}, wrench_start{0};
  std::vector<std::uint32_t> ids, bodies;
  std::vector<double> distances, wrenches;
  for (const SceneAnswer& answer : truth.frames) {
    for (const NearPair& near : answer.pairs) {
      ids.insert(ids.end(), {near.pair.a, near.pair.b});
      distances.push_back(near.distance);
    }
    for (const BodyWrench& wrench : answer.wrenches) {
      bodies.push_back(wrench.body);
      wrenches.insert(wrenches.end(), wrench.force.data(), wrench.force.data() + 3);
      wrenches.insert(wrenches.end(), wrench.torque.data(), wrench.torque.data() + 3);
    }
    pair_start.push_back(distances.size());
    wrench_start.push_back(bodies.size());
  }
  CacheEntry entry;
  entry.put("pair_start", std::move(pair_start));
  entry.put("wrench_start", std::move(wrench_start));
  entry.put("pair", std::move(ids));
  entry.put("distance", std::move(distances));
  entry.put("body", std::move(bodies));
  entry.put("wrench", std::move(wrenches));
  return entry;
}

SceneAnswers unpack(CacheEntry entry) {
  const auto pair_start = entry.take<std::uint64_t>("pair_start"),
             wrench_start = entry.take<std::uint64_t>("wrench_start");
  const auto ids = entry.take<std::uint32_t>("pair"), bodies = entry.take<std::uint32_t>("body");
  const auto distances = entry.take<double>("distance"), wrenches = entry.take<double>("wrench");
  SceneAnswers truth;
  for (std::size_t f = 0; f + 1 < pair_start.size(); ++f) {
    SceneAnswer& answer = truth.frames.emplace_back();
    for (std::size_t k = pair_start[f]; k < pair_start[f + 1]; ++k) {
      answer.pairs.push_back({{ids[2 * k], ids[2 * k + 1]}, distances[k]});
    }
    for (std::size_t k = wrench_start[f]; k < wrench_start[f + 1]; ++k) {
      answer.wrenches.push_back({bodies[k], Eigen::Vector3d(&wrenches[6 * k]), Eigen::Vector3d(&wrenches[6 * k + 3])});
    }
  }
  return truth;
}

}  // namespace

void set_hash(SceneAnswers& truth) {
  ContentHash hash;
  for (const SceneAnswer& answer : truth.frames) hash.add_values(std::span<const char>(answer.hash()));
  truth.hash = hash.hex();
}

std::size_t SceneAnswers::pairs() const {
  std::size_t sum = 0;
  for (const SceneAnswer& answer : frames) sum += answer.pairs.size();
  return sum;
}

SceneAnswers replay(const Scene& scene, const SceneAlgorithm& algorithm, Question question,
                    const std::function<bool()>& cancelled) {
  const auto query = algorithm.prepare(scene, question);
  SceneAnswers truth;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    if (cancelled && cancelled()) throw Interrupted("interrupted");
    query->deform(shapes_of(scene, f));
    query->update(moves_of(scene.frames[f]));
    truth.frames.push_back(query->answer());
  }
  set_hash(truth);
  return truth;
}

SceneAnswers truth_of(const Scene& scene, Question question, const std::function<bool()>& cancelled) {
  const std::string key = key_of(scene, question);
  if (auto entry = load_cached(k_kind, key)) {
    SceneAnswers truth = unpack(std::move(*entry));
    set_hash(truth);
    return truth;
  }
  SceneAnswers truth = replay(scene, *make_all_pairs(), question, cancelled);
  store_cached(k_kind, key, pack(truth));
  return truth;
}

}  // namespace sixdof::scene
