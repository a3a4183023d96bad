#include "bench/harness/stock.h"

#include <fmt/format.h>

#include <sixdof/algorithm/exact.h>
#include <sixdof/base/error.h>
#include "bench/harness/timing.h"
#include <sixdof/models/model_catalogue.h>

namespace sixdof::bench {

const Mesh& Stock::mesh(const std::string& model) {
  auto& slot = meshes_[model];
  if (!slot) {
    slot = std::make_unique<const Mesh>(load_model(model));
    ++counts_.meshes_loaded;
  }
  return *slot;
}

const ConfigurationSet& Stock::set(const CatalogueEntry& set) {
  auto& slot = sets_[set.pair];
  if (!slot) {
    slot = std::make_unique<const ConfigurationSet>(set.file);
    ++counts_.sets_opened;
  }
  return *slot;
}

const BucketSample& Stock::bucket(const CatalogueEntry& entry, BucketKey key) {
  const auto place = std::pair(entry.pair, key);
  if (const auto found = buckets_.find(place); found != buckets_.end()) return found->second;
  const Mesh& a = mesh(entry.a);
  const Mesh& b = mesh(entry.b);
  const ConfigurationSet& opened = set(entry);
  opened.check_meshes(a, b);
  BucketSample sample = sample_bucket(opened, key, a, b, sample_, seed_);
  ++counts_.buckets_read;
  if (poses_ + sample.poses.size() > k_most_poses) {
    buckets_.clear();
    poses_ = 0;
  }
  poses_ += sample.poses.size();
  return buckets_.emplace(place, std::move(sample)).first->second;
}

const std::vector<Response>& Stock::true_responses(const CatalogueEntry& set, BucketKey key, double seconds) {
  std::vector<Response>& responses = true_responses_[{set.pair, key}];
  if (!responses.empty()) return responses;
  const BucketSample& sample = bucket(set, key);
  const auto exact = make_exact_algorithm();
  Query& truth = query(*exact, exact->settings(), set.a, set.b);
  const auto start = Clock::now();
  for (const Pose& pose : sample.poses) {
    const bool late = std::chrono::duration<double>(Clock::now() - start).count() > seconds;
    if (responses.size() == k_most_true || (late && responses.size() >= BucketSample::k_run)) break;
    const Outcome<Response> answer = truth.respond(pose);
    if (!answer.ok()) throw Error(fmt::format("{}: exact gives no response: {}", set.pair, truth.diagnosis()));
    responses.push_back(answer.value);
  }
  return responses;
}

std::unique_ptr<Query> Stock::prepare(const Algorithm& algorithm, const Settings& settings, const Mesh& a,
                                      const Mesh& b) {
  ++counts_.structures_prepared;
  return algorithm.prepare(a, b, settings);
}

Query& Stock::query(const Algorithm& algorithm, const Settings& settings, const std::string& a, const std::string& b) {
  const std::string key = algorithm.traits().name + "|" + settings.to_string() + "|" + a + "|" + b;
  for (auto it = prepared_.begin(); it != prepared_.end(); ++it) {
    if (it->key != key) continue;
    prepared_.splice(prepared_.begin(), prepared_, it);
    return *prepared_.front().query;
  }
  Prepared fresh{.key = key, .query = prepare(algorithm, settings, mesh(a), mesh(b))};
  fresh.bytes = fresh.query->footprint().bytes;
  prepared_.push_front(std::move(fresh));
  std::size_t bytes = 0;
  for (auto it = prepared_.begin(); it != prepared_.end();) {
    bytes += it->bytes;
    it = bytes > k_most_structure_bytes && it != prepared_.begin() ? prepared_.erase(it) : std::next(it);
  }
  return *prepared_.front().query;
}

std::vector<std::pair<std::string, std::string>> Stock::hashes() const {
  std::vector<std::pair<std::string, std::string>> list;
  for (const auto& [name, mesh] : meshes_) {
    if (mesh) list.emplace_back("mesh:" + name, mesh->hash());
  }
  for (const auto& [name, set] : sets_) {
    if (set) list.emplace_back("set:" + name, set->hash());
  }
  return list;
}

}  // namespace sixdof::bench
