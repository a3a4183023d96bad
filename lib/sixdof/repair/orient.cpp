#include <sixdof/repair/steps.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/shells.h>

namespace sixdof::repairing {
namespace {

constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();

struct Patch {
  std::uint32_t first = 0;  ///< Its lowest triangle.
  std::size_t triangles = 0;
  std::size_t turned = 0;  ///< Triangles to turn so that all agree with the first.
  bool orientable = true;  ///< Whether they can agree.
  bool closed = true;      ///< Then: whether each edge is used in both directions equally often.
  double volume = 0.0;     ///< Then, if closed: signed, all agreeing with the first.
  bool turn_all = false;   ///< Besides, turn every triangle of the patch.
  bool most_turned() const { return 2 * turned > triangles; }
};

/// The patches of a surface, and how each triangle must turn to agree with the first of its patch.
class Patches {
 public:
  explicit Patches(const RawMesh& surface)
      : of_triangle(surface.triangles.size(), k_none),
        turns(surface.triangles.size(), 0),
        surface_(surface),
        sides_(sorted_sides(surface.triangles)) {
    pair_sides();
    for (std::uint32_t t = 0; t < of_triangle.size(); ++t) {
      if (of_triangle[t] == k_none) flood(t);
    }
    find_closed();
    for (std::uint32_t t = 0; t < of_triangle.size(); ++t) all[of_triangle[t]].volume += tetrahedron(t);
  }

  std::vector<Patch> all;
  std::vector<std::uint32_t> of_triangle;
  std::vector<std::uint8_t> turns;

 private:
  void pair_sides() {
    across_.assign(3 * of_triangle.size(), k_none);
    same_direction_.assign(3 * of_triangle.size(), 0);
    for_each_edge(sides_, [&](std::span<const Side> edge) {
      if (edge.size() != 2) return;
      across_[edge[0].corner] = edge[1].triangle();
      across_[edge[1].corner] = edge[0].triangle();
      same_direction_[edge[0].corner] = same_direction_[edge[1].corner] = edge[0].forward == edge[1].forward ? 1 : 0;
    });
  }

  void flood(std::uint32_t first) {
    const auto number = static_cast<std::uint32_t>(all.size());
    Patch patch{.first = first};
    std::vector<std::uint32_t> queue{first};
    of_triangle[first] = number;
    while (!queue.empty()) {
      const std::uint32_t t = queue.back();
      queue.pop_back();
      ++patch.triangles;
      patch.turned += turns[t];
      for (std::uint32_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
        const std::uint32_t n = across_[corner];
        if (n == k_none) continue;
        const auto turn = static_cast<std::uint8_t>(turns[t] ^ same_direction_[corner]);
        if (of_triangle[n] == k_none) {
          of_triangle[n] = number;
          turns[n] = turn;
          queue.push_back(n);
        } else if (turns[n] != turn) {
          patch.orientable = false;
        }
      }
    }
    all.push_back(patch);
  }

  void find_closed() {
    std::map<std::uint32_t, int> balance;  // by patch, at one edge
    for_each_edge(sides_, [&](std::span<const Side> edge) {
      balance.clear();
      for (const Side& s : edge) {
        balance[of_triangle[s.triangle()]] += s.forward != (turns[s.triangle()] != 0) ? 1 : -1;
      }
      for (const auto& [patch, sum] : balance) all[patch].closed = all[patch].closed && sum == 0;
    });
  }

  double tetrahedron(std::uint32_t t) const {
    const Eigen::Vector3d& origin = surface_.vertices[surface_.triangles[all[of_triangle[t]].first][0]];
    const double volume = surface_.tetrahedron(surface_.triangles[t], origin);
    return turns[t] != 0 ? -volume : volume;
  }

  const RawMesh& surface_;
  const std::vector<Side> sides_;
  std::vector<std::uint32_t> across_;         ///< The triangle beyond each corner's side.
  std::vector<std::uint8_t> same_direction_;  ///< Whether both triangles use the side in one direction.
};

/// For each patch the largest closed one around it, if there is any.
std::vector<std::optional<std::uint32_t>> outermost_around(const RawMesh& surface, const Patches& patches) {
  std::vector<std::optional<std::uint32_t>> around(patches.all.size());
  const auto encloses = [&](std::uint32_t p) { return patches.all[p].closed && patches.all[p].orientable; };
  std::size_t closed = 0;
  for (std::uint32_t p = 0; p < patches.all.size(); ++p) closed += encloses(p) ? 1 : 0;
  if (closed < 2) return around;

  std::vector<Triangle> triangles = surface.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (patches.turns[t] != 0) std::swap(triangles[t][1], triangles[t][2]);
  }
  const Mesh mesh = Mesh::build(surface.vertices, std::move(triangles));
  const Tree tree(mesh);
  for (std::uint32_t p = 0; p < patches.all.size(); ++p) {
    if (!encloses(p)) continue;
    const Eigen::Vector3d sample = surface.middle(surface.triangles[patches.all[p].first]);
    double largest = 0.0;
    for (const auto& [other, winding] : windings_of_groups(tree, patches.of_triangle, sample)) {
      const double volume = std::abs(patches.all[other].volume);
      if (other == p || !encloses(other) || volume <= std::max(largest, std::abs(patches.all[p].volume))) continue;
      largest = volume;
      around[p] = other;
    }
  }
  return around;
}

}  // namespace

std::size_t orient(RawMesh& surface, RepairLog& log) {
  Patches patches(surface);
  const auto around = outermost_around(surface, patches);
  const auto faces_inwards = [&](std::uint32_t p) { return patches.all[p].volume < 0.0; };
  for (std::uint32_t p = 0; p < patches.all.size(); ++p) {
    Patch& patch = patches.all[p];
    if (!patch.orientable) continue;
    if (!patch.closed || patch.volume == 0.0) {
      patch.turn_all = patch.most_turned();
    } else if (!around[p]) {
      patch.turn_all = faces_inwards(p);
    } else {
      const std::uint32_t outer = *around[p];
      const bool outer_turns_over = faces_inwards(outer) != patches.all[outer].most_turned();
      patch.turn_all = patch.most_turned() != outer_turns_over;
    }
  }
  std::size_t turned = 0;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const Patch& patch = patches.all[patches.of_triangle[t]];
    if (!patch.orientable || (patches.turns[t] != 0) == patch.turn_all) continue;
    std::swap(surface.triangles[t][1], surface.triangles[t][2]);
    ++turned;
    log.add(RepairKind::flipped_triangles, surface.middle(surface.triangles[t]));
  }
  return turned;
}

}  // namespace sixdof::repairing
