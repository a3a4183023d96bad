#include "bench/harness/pair_cache.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/process/remote_algorithm.h>
#include "bench/common/mesh_warning.h"

namespace sixdof::bench {
namespace {

std::string prepared_key(const Algorithm& algorithm, const Settings& settings, const std::string& a,
                         const std::string& b) {
  // The exact responses come from this process, whatever is isolated.
  const char* const place = is_isolated(algorithm) ? "isolated" : "here";
  return fmt::format("{}|{}|{}|{}|{}", algorithm.traits().name, place, settings.to_string(), a, b);
}

}  // namespace

void require_solids(const Mesh& a, const Mesh& b) {
  for (const Mesh* mesh : {&a, &b}) {
    if (!mesh->solid()) throw NeedsSolid(fmt::format("{} ({})", mesh->name(), mesh->why_not_solid()));
  }
}

const Mesh& PairCache::mesh(const std::string& key) {
  if (!meshes_.contains(key)) keep(key, load_(key));
  return meshes_.at(key)->mesh;
}

void PairCache::keep(const std::string& key, LoadedMesh mesh) {
  if (meshes_.contains(key)) return;
  meshes_.emplace(key, std::make_unique<const LoadedMesh>(std::move(mesh)));
  ++counts_.meshes_loaded;
}

const BucketSample& PairCache::bucket(const CatalogueEntry& entry, BucketKey key) {
  const PairBucket name(entry.pair, key);
  if (const auto found = buckets_.find(name); found != buckets_.end()) return found->second;
  const Mesh& a = mesh(entry.a);
  const Mesh& b = mesh(entry.b);
  auto& set = sets_[entry.pair];
  if (!set) {
    set = std::make_unique<const ConfigurationSet>(entry.file);
    ++counts_.sets_opened;
  }
  set->check_meshes(a, b);
  BucketSample sample = sample_bucket(*set, key, a, b, sample_, seed_);
  ++counts_.buckets_read;
  if (poses_ + sample.poses.size() > k_most_poses) {
    buckets_.clear();
    poses_ = 0;
  }
  poses_ += sample.poses.size();
  return buckets_.emplace(name, std::move(sample)).first->second;
}

std::span<const Response> PairCache::exact_responses(const CatalogueEntry& entry, BucketKey key, std::size_t count) {
  require_solids(mesh(entry.a), mesh(entry.b));
  const BucketSample& sample = bucket(entry, key);
  count = std::min({count, k_most_exact, sample.poses.size()});
  std::vector<Response>& responses = exact_responses_[{entry.pair, key}];
  if (responses.size() < count) {
    const auto exact = make_exact_algorithm();
    Query& exact_query = query(*exact, exact->settings(), entry.a, entry.b);
    while (responses.size() < count) {
      const Outcome<Response> answer = exact_query.respond(sample.poses[responses.size()]);
      if (!answer.ok()) {
        throw Error(fmt::format("{}: exact gives no response: {}", entry.pair, exact_query.diagnosis()));
      }
      responses.push_back(answer.value);
    }
  }
  return std::span(responses).first(count);
}

HullTruth& PairCache::hull_truth(const CatalogueEntry& entry) {
  std::unique_ptr<HullTruth>& truth = hull_truths_[entry.pair];
  if (!truth) truth = std::make_unique<HullTruth>(mesh(entry.a), mesh(entry.b));
  return *truth;
}

DepthTruths& PairCache::depth_truths(const CatalogueEntry& entry) {
  require_solids(mesh(entry.a), mesh(entry.b));
  std::unique_ptr<DepthTruths>& truths = depth_truths_[entry.pair];
  if (!truths) truths = std::make_unique<DepthTruths>(mesh(entry.a), mesh(entry.b));
  return *truths;
}

std::unique_ptr<Query> PairCache::prepare(const Algorithm& algorithm, const Settings& settings, const Mesh& a,
                                          const Mesh& b) {
  ++counts_.structures_prepared;
  std::unique_ptr<Query> query;
  try {
    query = algorithm.prepare(a, b, settings);
  } catch (const BadMesh&) {
    require_solids(a, b);
    throw;
  }
  if (!query) throw Error(fmt::format("algorithm {}: prepare() returned a null pointer", algorithm.traits().name));
  return query;
}

bool PairCache::is_prepared(const Algorithm& algorithm, const Settings& settings, const std::string& a,
                            const std::string& b) const {
  const std::string key = prepared_key(algorithm, settings, a, b);
  return std::ranges::find(prepared_, key, &Prepared::key) != prepared_.end();
}

Query& PairCache::query(const Algorithm& algorithm, const Settings& settings, const std::string& a,
                        const std::string& b) {
  const std::string key = prepared_key(algorithm, settings, a, b);
  if (const auto found = std::ranges::find(prepared_, key, &Prepared::key); found != prepared_.end()) {
    prepared_.splice(prepared_.begin(), prepared_, found);
    if (RemoteQuery* const remote = as_remote(*found->query)) remote->forgive();
    return *found->query;
  }
  Prepared fresh{.key = key, .query = prepare(algorithm, settings, mesh(a), mesh(b))};
  fresh.bytes = fresh.query->footprint().bytes;
  prepared_.push_front(std::move(fresh));
  std::size_t bytes = 0;
  for (auto it = prepared_.begin(); it != prepared_.end();) {
    bytes += it->bytes;
    it = bytes > k_most_prepared_bytes && it != prepared_.begin() ? prepared_.erase(it) : std::next(it);
  }
  return *prepared_.front().query;
}

std::vector<std::string> PairCache::warnings() const {
  std::vector<std::string> lines;
  for (const auto& [key, loaded] : meshes_) {
    std::string line = mesh_warning(loaded->mesh, loaded->argument);
    if (!line.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<std::pair<std::string, std::string>> PairCache::hashes() const {
  std::vector<std::pair<std::string, std::string>> list;
  for (const auto& [key, loaded] : meshes_) list.emplace_back("mesh:" + key, loaded->mesh.hash());
  for (const auto& [name, set] : sets_) {
    if (set) list.emplace_back("set:" + name, set->hash());
  }
  return list;
}

}  // namespace sixdof::bench
