#include <sixdof/results/rivals.h>

#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <tuple>

#include <fmt/format.h>

namespace sixdof::results {
namespace {

std::string place_to_compare(const RowGroup& group) {
  const RowFields& fields = group.fields();
  std::string place = fields.target.empty() ? place_of(fields) : fields.target;
  if (!fields.question.empty()) place += (place.empty() ? "" : ", ") + fields.question;
  if (const auto bodies = group.value("bodies")) place += fmt::format(", {:.0f} bodies", *bodies);
  if (const auto amplitude = group.value("amplitude")) place += fmt::format(", {:g} %", *amplitude);
  return place;
}

}  // namespace

std::vector<double> Rivalry::ratios() const {
  std::vector<double> list;
  for (std::size_t i = 0; i < own_ns.size(); ++i) list.push_back(rival_ns[i] / own_ns[i]);
  return list;
}

std::optional<double> rival_time(const RowGroup& group, RivalTime which) {
  if (which == RivalTime::p99) return group.value(is_scene(group.fields()) ? "p99_frame_ns" : "p99_ns");
  if (group.fields().query == "generate") return group.value("ns_per_configuration");
  if (is_scene(group.fields())) return group.value("processor_ns");
  const auto time = group.mean_time();
  return time ? std::optional(time->value) : std::nullopt;
}

bool fits(const std::string& name, std::span<const std::string> patterns) {
  return std::ranges::any_of(
      patterns, [&](const std::string& pattern) { return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0; });
}

std::vector<Rivalry> rivalries(std::span<const RowGroup> groups, const std::string& algorithm,
                               std::span<const std::string> against, RivalTime time) {
  struct Sides {
    std::optional<double> own_ns, rival_ns;
    std::string rival;
  };
  using Key = std::tuple<std::string, std::string, std::string>;
  std::vector<std::pair<Key, std::map<std::size_t, Sides>>> all;
  for (const RowGroup& group : groups) {
    const std::optional<double> ns = rival_time(group, time);
    if (!ns || !(*ns > 0.0) || !group.faults.empty() || group.is_special()) continue;
    const Key key{group.fields().query, bodies_of(group.fields()), place_to_compare(group)};
    auto place = std::ranges::find(all, key, [](const auto& entry) { return entry.first; });
    if (place == all.end()) place = all.insert(all.end(), {key, {}});
    Sides& sides = place->second[group.row().file];
    if (group.fields().algorithm == algorithm) {
      sides.own_ns = ns;
    } else if (fits(group.fields().algorithm, against) && (!sides.rival_ns || *ns < *sides.rival_ns)) {
      sides.rival_ns = ns;
      sides.rival = group.fields().algorithm;
    }
  }
  std::vector<Rivalry> found;
  for (const auto& [key, by_file] : all) {
    Rivalry rivalry{.query = std::get<0>(key),
                    .bodies = std::get<1>(key),
                    .place = std::get<2>(key),
                    .own_ns = {},
                    .rival_ns = {},
                    .rivals = {}};
    for (const auto& [file, sides] : by_file) {
      if (!sides.own_ns || !sides.rival_ns) continue;
      rivalry.own_ns.push_back(*sides.own_ns);
      rivalry.rival_ns.push_back(*sides.rival_ns);
      rivalry.rivals.push_back(sides.rival);
    }
    if (!rivalry.own_ns.empty()) found.push_back(std::move(rivalry));
  }
  return found;
}

}  // namespace sixdof::results
