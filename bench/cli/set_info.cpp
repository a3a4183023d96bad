#include "bench/cli/set_info.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/configuration/configuration_set.h>

namespace sixdof::cli {
namespace {

nlohmann::ordered_json as_json(const MeshIdentity& mesh) {
  return {{"name", mesh.name},
          {"content_hash", mesh.hash},
          {"triangles", mesh.triangles},
          {"box_min", {mesh.box_min.x(), mesh.box_min.y(), mesh.box_min.z()}},
          {"box_max", {mesh.box_max.x(), mesh.box_max.y(), mesh.box_max.z()}},
          {"volume", mesh.volume}};
}

void print_json(const ConfigurationSet& set) {
  const SetDescription& d = set.description();
  nlohmann::ordered_json json = {{"file", set.path().string()},
                                 {"content_hash", set.hash()},
                                 {"generator_version", d.generator_version},
                                 {"grid", d.grid.spec},
                                 {"sampler", d.grid.sampler},
                                 {"directions", d.grid.directions.size()},
                                 {"rotations", d.grid.rotations.size()},
                                 {"configurations_per_bucket", d.grid.configurations()},
                                 {"a", as_json(d.a)},
                                 {"b", as_json(d.b)}};
  if (d.volume_grid) {
    json["volume_grid"] = {{"grid", d.volume_grid->spec},
                           {"directions", d.volume_grid->directions.size()},
                           {"rotations", d.volume_grid->rotations.size()},
                           {"configurations_per_bucket", d.volume_grid->configurations()}};
  }
  auto buckets = nlohmann::ordered_json::array();
  for (const BucketSummary& bucket : set.buckets()) {
    buckets.push_back({{"bucket", bucket.key.name()},
                       {"nominal", bucket.nominal},
                       {"target", bucket.target},
                       {"tolerance", bucket.tolerance},
                       {"largest_residual", bucket.largest_residual},
                       {"reachable", bucket.reachable},
                       {"oracle", bucket.oracle},
                       {"oracle_version", bucket.oracle_version},
                       {"content_hash", bucket.hash}});
  }
  json["buckets"] = std::move(buckets);
  fmt::print("{}\n", json.dump(2));
}

void print_grid(const char* label, const Grid& grid) {
  fmt::print("{:<18} {} ({}): {} directions x {} rotations = {} configurations per bucket\n", label, grid.spec,
             grid.sampler, grid.directions.size(), grid.rotations.size(), grid.configurations());
}

void print_text(const ConfigurationSet& set) {
  const SetDescription& d = set.description();
  fmt::print("configuration set  {}\n", set.path().string());
  fmt::print("content hash       {}\n", set.hash());
  fmt::print("made by            sixdof {}\n", d.generator_version);
  for (const auto& [label, mesh] : {std::pair("A (fixed)", &d.a), std::pair("B (moving)", &d.b)}) {
    fmt::print("{:<18} {}: {} triangles, box diagonal {:.6g}, volume {:.6g}, content hash {}\n", label, mesh->name,
               mesh->triangles, mesh->diagonal(), mesh->volume, mesh->hash);
  }
  print_grid(d.volume_grid ? "grid of distances" : "grid", d.grid);
  if (d.volume_grid) print_grid("grid of volumes", *d.volume_grid);
  fmt::print("\n{:<13} {:>14} {:>10} {:>14} {:>10}  {}\n", "bucket", "nominal", "tolerance", "largest resid.",
             "reachable", "oracle");
  for (const BucketSummary& bucket : set.buckets()) {
    fmt::print("{:<13} {:>14.6g} {:>10.1e} {:>14.1e} {:>10}  {} {}\n", bucket.key.name(), bucket.nominal,
               bucket.tolerance, bucket.largest_residual, bucket.reachable, bucket.oracle, bucket.oracle_version);
  }
}

}  // namespace

void print_set_info(const std::string& file, bool as_json) {
  const ConfigurationSet set(file);
  as_json ? print_json(set) : print_text(set);
}

}  // namespace sixdof::cli
