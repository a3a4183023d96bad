#include <sixdof/configuration/generation_job.h>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>
#include <sixdof/configuration/set_fields.h>

namespace sixdof {
namespace {

std::vector<BucketSummary> bucket_list(const Mesh& a, std::span<const double> distances,
                                       std::span<const double> volumes) {
  std::vector<BucketSummary> buckets;
  for (const double percent : distances) buckets.push_back(distance_bucket(a, percent));
  for (const double percent : volumes) buckets.push_back(volume_bucket(a, percent));
  std::ranges::sort(buckets, {}, &BucketSummary::key);
  const auto repeated = std::ranges::adjacent_find(buckets, {}, &BucketSummary::key);
  if (repeated != buckets.end()) throw BadArgument(fmt::format("bucket {}: asked for twice", repeated->key.name()));
  if (buckets.empty()) throw BadArgument("no bucket to generate");
  return buckets;
}

std::string words(const MeshIdentity& mesh) {
  return fmt::format("{} ({} triangles, content hash {})", mesh.name, mesh.triangles, mesh.hash);
}

std::string words(const std::optional<GridIdentity>& grid) {
  return grid ? fmt::format("{} (content hash {})", grid->spec, grid->hash) : "none";
}

std::string words(const std::vector<BucketSummary>& buckets) {
  std::vector<std::string> list;
  for (const BucketSummary& b : buckets) {
    list.push_back(fmt::format("{} at {:.17g} +- {:.17g}", b.key.name(), b.target, b.tolerance));
  }
  return fmt::format("{}", fmt::join(list, ", "));
}

Grid make_again(const GridIdentity& identity) {
  Grid grid = make_grid(identity.spec);
  if (GridIdentity::of(grid) == identity) return grid;
  throw BadArgument(
      fmt::format("grid {}: this build makes another grid of that name than the shards have", identity.spec));
}

}  // namespace

GridIdentity GridIdentity::of(const Grid& grid) { return {.spec = grid.spec, .hash = detail::hash_of(grid)}; }

GenerationJob GenerationJob::of(std::string program, const std::string& oracle, const std::string& oracle_version,
                                const Mesh& a, const SetDescription& set, std::span<const double> distances,
                                std::span<const double> volumes) {
  GenerationJob job{.program = std::move(program),
                    .generator_version = set.generator_version,
                    .oracle = oracle,
                    .oracle_version = oracle_version,
                    .a = set.a,
                    .b = set.b,
                    .grid = GridIdentity::of(set.grid),
                    .volume_grid = std::nullopt,
                    .buckets = bucket_list(a, distances, volumes)};
  if (set.volume_grid) job.volume_grid = GridIdentity::of(*set.volume_grid);
  return job;
}

bool GenerationJob::has(BucketKind kind) const {
  return std::ranges::any_of(buckets, [&](const BucketSummary& bucket) { return bucket.key.kind == kind; });
}

std::string GenerationJob::hash() const {
  detail::FieldHash hash;
  for (const std::string* field : {&program, &generator_version, &oracle, &oracle_version}) hash.add(*field);
  hash.add(a);
  hash.add(b);
  hash.add(words(grid));
  hash.add(words(volume_grid));
  for (const BucketSummary& bucket : buckets) {
    hash.add(bucket.key.name());
    hash.add(bucket.nominal);
    hash.add(bucket.target);
    hash.add(bucket.tolerance);
  }
  return hash.hex();
}

std::string GenerationJob::difference(const GenerationJob& other) const {
  std::vector<std::string> list;
  const auto compare = [&](const char* what, const std::string& mine, const std::string& theirs) {
    if (mine != theirs) list.push_back(fmt::format("{} {}, not {}", what, mine, theirs));
  };
  compare("mesh A is", words(a), words(other.a));
  compare("mesh B is", words(b), words(other.b));
  compare("the grid is", words(grid), words(other.grid));
  compare("the volumes' grid is", words(volume_grid), words(other.volume_grid));
  compare("the distances are by", oracle + " " + oracle_version, other.oracle + " " + other.oracle_version);
  compare("the buckets are", words(buckets), words(other.buckets));
  compare("made by sixdof", program, other.program);
  if (list.empty() && hash() != other.hash()) list.emplace_back("versions or measures of the meshes differ");
  return fmt::format("{}", fmt::join(list, "; "));
}

SetDescription GenerationJob::describe() const {
  SetDescription set{
      .generator_version = generator_version, .a = a, .b = b, .grid = make_again(grid), .volume_grid = std::nullopt};
  if (volume_grid) set.volume_grid = make_again(*volume_grid);
  return set;
}

std::span<const std::uint32_t> rotations_of(ShardNumber shard, const DistinctRotations& distinct) {
  const std::size_t begin = distinct.first.size() * (shard.number - 1) / shard.count;
  const std::size_t end = distinct.first.size() * shard.number / shard.count;
  return std::span(distinct.first).subspan(begin, end - begin);
}

void check_shard_number(ShardNumber shard, const SetDescription& set, const GenerationJob& job) {
  if (shard.number < 1 || shard.number > shard.count) {
    throw BadArgument(
        fmt::format("shard {} of {}: shards are numbered 1 to {}", shard.number, shard.count, shard.count));
  }
  for (const BucketKind kind : {BucketKind::distance, BucketKind::volume}) {
    if (!job.has(kind)) continue;
    const std::size_t distinct = DistinctRotations(set.grid_of(kind).rotations).first.size();
    if (shard.count > distinct) {
      throw BadArgument(fmt::format("{} shards: grid {} of the {}s has only {} distinct rotations", shard.count,
                                    set.grid_of(kind).spec, to_string(kind), distinct));
    }
  }
}

}  // namespace sixdof
