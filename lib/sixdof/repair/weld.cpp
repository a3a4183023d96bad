#include <sixdof/repair/steps.h>

#include <map>
#include <numeric>

#include <sixdof/repair/neighbours.h>

namespace sixdof::repairing {
namespace {

enum class Place : std::uint8_t {
  unused,
  inner,
  border
};

std::vector<Place> places_of(const RawMesh& surface) {
  std::vector<Place> places(surface.vertices.size(), Place::unused);
  for (const Triangle& t : surface.triangles) {
    for (const std::uint32_t v : t) places[v] = Place::inner;
  }
  for (const Side& side : border_sides(sorted_sides(surface.triangles))) {
    places[side.low] = places[side.high] = Place::border;
  }
  return places;
}

/// The inner vertex closest to `v` within the tolerance; `v` itself if there is none.
std::uint32_t closest_inner(const RawMesh& surface, const Neighbours& neighbours, const std::vector<Place>& places,
                            std::uint32_t v, double tolerance) {
  std::uint32_t closest = v;
  double least = tolerance * tolerance;
  for (const std::uint32_t n : neighbours.within(surface.vertices[v], tolerance)) {
    const double squared = (surface.vertices[n] - surface.vertices[v]).squaredNorm();
    if (places[n] != Place::inner || squared >= least) continue;
    least = squared;
    closest = n;
  }
  return closest;
}

}  // namespace

void renumber(RawMesh& surface, std::span<const std::uint32_t> number, RepairLog& log) {
  for (Triangle& t : surface.triangles) {
    for (std::uint32_t& v : t) v = number[v];
  }
  std::erase_if(surface.triangles, [&](const Triangle& t) {
    if (!is_collapsed(t)) return false;
    log.add(RepairKind::degenerate_triangles, surface.vertices[t[0]]);
    return true;
  });
}

std::size_t weld_border(RawMesh& surface, double tolerance, RepairLog& log) {
  const std::vector<Place> places = places_of(surface);
  std::vector<std::uint32_t> used, border;
  for (std::uint32_t v = 0; v < places.size(); ++v) {
    if (places[v] != Place::unused) used.push_back(v);
    if (places[v] == Place::border) border.push_back(v);
  }
  if (border.empty()) return 0;
  const Neighbours neighbours(surface.vertices, std::move(used));
  UnionFind clusters(places.size());
  for (const std::uint32_t v : border) {
    for (const std::uint32_t n : neighbours.within(surface.vertices[v], tolerance)) {
      if (places[n] == Place::border) clusters.join(n, v);
    }
  }
  std::vector<std::uint32_t> number(places.size());
  std::iota(number.begin(), number.end(), 0U);
  std::map<std::uint32_t, std::uint32_t> target_of_cluster;  // by the cluster's root
  std::size_t welded = 0;
  for (const std::uint32_t v : border) {  // ascending: the first of a cluster is its lowest
    const auto [target, is_first] = target_of_cluster.try_emplace(clusters.find(v), v);
    if (is_first) target->second = closest_inner(surface, neighbours, places, v, tolerance);
    number[v] = target->second;
    if (number[v] == v) continue;
    ++welded;
    log.add(RepairKind::welded_vertices, surface.vertices[v]);
  }
  if (welded > 0) renumber(surface, number, log);
  return welded;
}

}  // namespace sixdof::repairing
