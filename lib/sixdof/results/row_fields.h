#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <sixdof/configuration/bucket.h>

namespace sixdof::results {

/// What a row of sixdof-bench measures, so that no reader of a result file needs to take the row's name apart. A row's
/// JSON holds it as an object under k_row_fields_key.
struct RowFields {
  std::string query;      ///< "collide", "distance" or "respond"; of other rows the family: "prepare", "scenario", ...
  std::string algorithm;  ///< As in the registry; of a generate row the method.
  std::string settings = {};  ///< Of the algorithm: "name=value,name=value".
  std::string pair = {};      ///< Empty where the row belongs to none.
  std::optional<BucketKey> bucket = {};
  std::string order = {};     ///< Of a query's poses: "random", "path" (the grid's own order) or "motion";
                              ///< of a cast row how B moves and by what percent of A's diagonal: "tumble/10".
  std::string body = {};      ///< "convex_hull" where answers are not about the meshes; empty where they are.
  std::string runtime = {};   ///< Of a rival: "native", "python", "node" or "wasm" (Traits::runtime); empty elsewhere.
  std::string cache = {};     ///< Of a query: "warm", or "cold" where data leaves the caches before each.
  std::string scenario = {};  ///< "II"; of a scene or deform row its family.
  std::string target = {};    ///< Of a generate row: "distance" or "volume".
  /// Of a row of responses, the law that `..._own_...` counters judge by (ResponseLaw): "depth"; empty for none.
  /// Of a scenario row, that of the ideal (IdealLaw): "traction".
  std::string law = {};
  bool isolated = false;      ///< The algorithm runs, and is timed, in a process of its own.
  bool approximates = false;  ///< The algorithm replaces the bodies by others, such as spheres (Traits::approximates).
  std::string question = {};  ///< Of a study's row: the kind of query that it asks.
  /// The row asks at most so many configurations, and is compared with rows of the same limit; empty without one.
  std::optional<std::uint64_t> sample_limit = {};
  /// How many were asked or made; empty where the row has none or could not be run.
  std::optional<std::uint64_t> configurations = {};
  // What the pair stands for where many are measured (measured_pairs.h); empty elsewhere.
  std::string object = {}, partner = {}, kind = {};  ///< Of a collection; "self" is the partner of an object's copy.
  std::string shape = {};                            ///< Of a study of growth.
  std::optional<std::uint64_t> triangles = {};       ///< Of the object or shape.
  std::optional<double> volume_unit = {};  ///< What volumes are in percent of, in volumes of A; empty: of A's volume.
};

/// Whether the row is of a scene that was replayed: of rigid bodies, or in which a mesh deforms.
inline bool is_scene(const RowFields& fields) { return fields.query == "scene" || fields.query == "deform"; }

inline constexpr const char* k_row_fields_key = "sixdof";

/// The percentage as a JSON number: whole ones without a point.
nlohmann::ordered_json percent_number(BucketKey key);

/// {"kind": "distance", "percent": 5} and back. @throws what nlohmann::json and BucketKey::parse() throw
nlohmann::ordered_json to_json_object(BucketKey key);
BucketKey bucket_of(const nlohmann::ordered_json& object);

/// "name=value,..." as RowFields::settings has it after a result was written and read: numbers in their shortest form.
std::string settings_as_read(const std::string& settings);

/// Keys are those of RowFields; empty members are left out. "settings"
/// is an object by parameter, always there, with numbers as numbers.
nlohmann::ordered_json to_json_object(const RowFields& fields);

/// The inverse. @throws Error with the key, e.g. "sixdof.bucket: ..."
RowFields row_fields_of(const nlohmann::ordered_json& object);

}  // namespace sixdof::results
