#include <sixdof/repair/steps.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/shells.h>

namespace sixdof::repairing {
namespace {

/// Largest part of the area that sheets outside may have together, as stray pieces may. Where there is more, they are
/// what the file is about: panels beside a small body.
constexpr double k_largest_total = 0.5;

/// A part of a surface that edges of two triangles connect.
struct Patch {
  std::uint32_t component = 0;  ///< What any edges connect.
  double area = 0.0;
  Eigen::Vector3d area_vector = Eigen::Vector3d::Zero();
  bool sheet = false;
  bool wall = false;
  bool dropped = false;
};

struct Component {
  std::size_t patches = 0;
  bool odd = false;           ///< Has an edge of an odd number of triangles.
  bool still_odd = false;     ///< Without the patches that are dropped.
  double rest = 0.0;          ///< Area of what is no sheet.
  double sheets = 0.0;        ///< Area of the sheets outside.
  double volume = 0.0;        ///< Largest of a cell's boundary: that of the outside.
  std::uint32_t outside = 0;  ///< Its cell.
  bool keep = false;          ///< Nothing of it is dropped.
};

class Cells {
 public:
  Cells(const RawMesh& surface, std::vector<Side> sides)
      : surface_(surface), sides_(std::move(sides)), cell_(2 * surface.triangles.size()) {
    divide();
    find_cells();
    classify();
  }

  std::vector<Patch> patches;
  std::vector<Component> components;
  std::vector<std::uint32_t> patch_of;  ///< Of each triangle.

  /// Marks sheets and walls as dropped, and takes it back where the rest is not closed.
  void drop_sheets_and_walls(double max_sheet) {
    for (Patch& patch : patches) {
      Component& component = components[patch.component];
      if (!patch.sheet || component.keep) continue;
      patch.dropped = true;
      if (!is_outside(patch)) continue;
      component.sheets += patch.area;
      if (patch.area > max_sheet * component.rest || component.sheets > k_largest_total * component.rest) {
        component.keep = true;
      }
    }
    while (drop_walls()) {
    }
    find_still_odd();
    for (Patch& patch : patches) {
      Component& component = components[patch.component];
      if (component.keep || component.still_odd) patch.dropped = false;
    }
    find_still_odd();
  }

 private:
  /// Side of a triangle that its normal points to, and the other.
  static std::uint32_t front(std::uint32_t t) { return 2 * t; }
  static std::uint32_t back(std::uint32_t t) { return 2 * t + 1; }

  void divide() {
    const std::size_t n = surface_.triangles.size();
    UnionFind patch(n), component(n);
    for_each_edge(sides_, [&](std::span<const Side> edge) {
      for (const Side& side : edge.subspan(1)) component.join(side.triangle(), edge[0].triangle());
      if (edge.size() == 2) patch.join(edge[1].triangle(), edge[0].triangle());
    });
    constexpr std::uint32_t k_none = ~std::uint32_t{0};
    std::vector<std::uint32_t> of_root(n, k_none), component_of_root(n, k_none);
    patch_of.resize(n);
    for (std::uint32_t t = 0; t < n; ++t) {
      std::uint32_t& c = component_of_root[component.find(t)];
      if (c == k_none) {
        c = static_cast<std::uint32_t>(components.size());
        components.emplace_back();
      }
      std::uint32_t& p = of_root[patch.find(t)];
      if (p == k_none) {
        p = static_cast<std::uint32_t>(patches.size());
        patches.push_back({.component = c});
        ++components[c].patches;
      }
      patch_of[t] = p;
      const Eigen::Vector3d normal = 0.5 * surface_.normal(surface_.triangles[t]);
      patches[p].area += normal.norm();
      patches[p].area_vector += normal;
    }
    for_each_edge(sides_, [&](std::span<const Side> edge) {
      if (edge.size() % 2 == 1) component_of(edge[0]).odd = true;
    });
  }

  Component& component_of(const Side& side) { return components[patches[patch_of[side.triangle()]].component]; }

  void find_cells() {
    std::vector<std::pair<double, const Side*>> around;
    for_each_edge(sides_, [&](std::span<const Side> edge) {
      if (!component_of(edge[0]).odd) return;
      if (edge.size() == 1) {
        cell_.join(front(edge[0].triangle()), back(edge[0].triangle()));
      } else if (edge.size() == 2) {
        const bool agree = edge[0].forward != edge[1].forward;
        const std::uint32_t a = edge[0].triangle(), b = edge[1].triangle();
        cell_.join(front(a), agree ? front(b) : back(b));
        cell_.join(back(a), agree ? back(b) : front(b));
      } else {
        around.clear();
        for (const Side& side : edge) around.emplace_back(angle(side, edge[0]), &side);
        std::stable_sort(around.begin(), around.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (std::size_t i = 0; i < around.size(); ++i) {
          const Side& side = *around[i].second;
          const Side& next = *around[(i + 1) % around.size()].second;
          // Seen along the edge, a triangle that uses it forward has its front where angles grow.
          cell_.join(side.forward ? front(side.triangle()) : back(side.triangle()),
                     next.forward ? back(next.triangle()) : front(next.triangle()));
        }
      }
    });
  }

  /// Of the side's triangle around its edge, counter-clockwise seen against the direction from low to high, from that
  /// of `zero`: -pi .. pi.
  double angle(const Side& side, const Side& zero) const {
    const Eigen::Vector3d& low = surface_.vertices[side.low];
    const Eigen::Vector3d axis = (surface_.vertices[side.high] - low).normalized();
    const auto across = [&](const Side& s) -> Eigen::Vector3d {
      const Eigen::Vector3d d = surface_.vertices[apex_of(s, surface_.triangles)] - low;
      return d - d.dot(axis) * axis;
    };
    const Eigen::Vector3d from = across(zero), to = across(side);
    return std::atan2(from.cross(to).dot(axis), from.dot(to));
  }

  /// Volumes of the cells' boundaries, with normals into the cell: positive outside, negative elsewhere.
  void classify() {
    std::vector<double> volume(2 * surface_.triangles.size(), 0.0);
    for (std::uint32_t t = 0; t < patch_of.size(); ++t) {
      const double tetrahedron =
          surface_.tetrahedron(surface_.triangles[t], surface_.vertices[surface_.triangles[0][0]]);
      volume[cell_.find(front(t))] += tetrahedron;
      volume[cell_.find(back(t))] -= tetrahedron;
    }
    std::vector<std::uint8_t> seen(patches.size(), 0);
    front_cell_.resize(patches.size());
    back_cell_.resize(patches.size());
    for (std::uint32_t t = 0; t < patch_of.size(); ++t) {
      const std::uint32_t p = patch_of[t];
      if (std::exchange(seen[p], std::uint8_t{1}) != 0) continue;
      front_cell_[p] = cell_.find(front(t));
      back_cell_[p] = cell_.find(back(t));
      patches[p].sheet = front_cell_[p] == back_cell_[p];
      Component& component = components[patches[p].component];
      if (!patches[p].sheet) component.rest += patches[p].area;
      for (const std::uint32_t cell : {front_cell_[p], back_cell_[p]}) {
        if (volume[cell] <= component.volume) continue;
        component.volume = volume[cell];
        component.outside = cell;
      }
    }
    for (std::uint32_t p = 0; p < patches.size(); ++p) {
      Component& component = components[patches[p].component];
      component.keep = !component.odd || component.volume == 0.0 || component.rest == 0.0;
      patches[p].wall = !patches[p].sheet && front_cell_[p] != component.outside && back_cell_[p] != component.outside;
    }
  }

  bool is_outside(const Patch& patch) const {
    const auto p = static_cast<std::size_t>(&patch - patches.data());
    return front_cell_[p] == components[patch.component].outside;
  }

  /// Drops walls that an edge of an odd number of triangles leaves no choice about; false if there is none.
  bool drop_walls() {
    bool any = false;
    for_each_edge(sides_, [&](std::span<const Side> edge) {
      if (component_of(edge[0]).keep || left_at(edge) % 2 == 0) return;
      std::optional<std::uint32_t> only;
      for (const Side& side : edge) {
        const std::uint32_t p = patch_of[side.triangle()];
        if (patches[p].dropped || !patches[p].wall || only == p) continue;
        if (only) return;
        only = p;
      }
      if (!only) return;
      patches[*only].dropped = true;
      any = true;
    });
    return any;
  }

  std::size_t left_at(std::span<const Side> edge) const {
    return static_cast<std::size_t>(std::count_if(
        edge.begin(), edge.end(), [&](const Side& side) { return !patches[patch_of[side.triangle()]].dropped; }));
  }

  void find_still_odd() {
    for (Component& component : components) component.still_odd = false;
    for_each_edge(sides_, [&](std::span<const Side> edge) {
      if (left_at(edge) % 2 == 1) component_of(edge[0]).still_odd = true;
    });
  }

  const RawMesh& surface_;
  const std::vector<Side> sides_;
  UnionFind cell_;                                     ///< Of the fronts and backs of triangles.
  std::vector<std::uint32_t> front_cell_, back_cell_;  ///< Of the patches' first triangles.
};

/// The middles of all triangles of a component lie inside of what is closed.
class Inside {
 public:
  Inside(const RawMesh& surface, const Cells& cells) : surface_(surface), cells_(cells) {
    std::vector<Triangle> closed;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const Patch& patch = cells.patches[cells.patch_of[t]];
      if (!patch.dropped && !cells.components[patch.component].still_odd) closed.push_back(surface.triangles[t]);
    }
    if (closed.empty()) return;
    const Mesh mesh = Mesh::build(surface.vertices, std::move(closed));
    if (mesh.diagonal() < Tree::k_smallest_diagonal || mesh.diagonal() > Tree::k_largest_diagonal) return;
    tree_.emplace(mesh);
    group_.assign(mesh.triangles().size(), 0);
  }

  bool operator()(std::uint32_t component) const {
    if (!tree_) return false;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      if (cells_.patches[cells_.patch_of[t]].component != component) continue;
      if (windings_of_groups(*tree_, group_, surface_.middle(surface_.triangles[t])).empty()) return false;
    }
    return true;
  }

 private:
  const RawMesh& surface_;
  const Cells& cells_;
  std::optional<Tree> tree_;
  std::vector<std::uint32_t> group_;
};

/// Marks stray pieces as dropped.
void drop_stray_pieces(const RawMesh& surface, double max_sheet, Cells& cells) {
  double closed_area = 0.0;
  for (const Patch& patch : cells.patches) {
    const Component& component = cells.components[patch.component];
    if (!component.still_odd && !patch.dropped) closed_area += patch.area;
    // Everything else must be closed.
    if (component.still_odd && (component.patches > 1 || patch.area_vector.norm() <= k_largest_hole * patch.area))
      return;
  }
  if (closed_area == 0.0) return;
  std::optional<Inside> inside;
  std::vector<std::uint32_t> stray;
  double area = 0.0;
  for (std::uint32_t p = 0; p < cells.patches.size(); ++p) {
    const Patch& patch = cells.patches[p];
    if (!cells.components[patch.component].still_odd) continue;
    area += patch.area;
    if (patch.area > max_sheet * closed_area || area > k_largest_total * closed_area) {
      if (!inside) inside.emplace(surface, cells);
      if (!(*inside)(patch.component)) return;
    }
    stray.push_back(p);
  }
  for (const std::uint32_t p : stray) cells.patches[p].dropped = true;
}

}  // namespace

std::size_t drop_superfluous(RawMesh& surface, double max_sheet, RepairLog& log) {
  std::vector<Side> sides = sorted_sides(surface.triangles);
  bool odd = false;
  for_each_edge(sides, [&](std::span<const Side> edge) { odd = odd || edge.size() % 2 == 1; });
  if (!odd) return 0;
  Cells cells(surface, std::move(sides));
  cells.drop_sheets_and_walls(max_sheet);
  drop_stray_pieces(surface, max_sheet, cells);

  std::vector<std::uint8_t> dropped(surface.triangles.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Patch& patch = cells.patches[cells.patch_of[t]];
    if (!patch.dropped) continue;
    dropped[t] = 1;
    const Triangle& triangle = surface.triangles[t];
    const RepairKind kind = is_degenerate(surface, triangle)              ? RepairKind::degenerate_triangles
                            : cells.components[patch.component].still_odd ? RepairKind::stray_triangles
                            : patch.sheet                                 ? RepairKind::fins
                                                                          : RepairKind::inner_walls;
    log.add(kind, surface.middle(triangle));
  }
  const std::size_t before = surface.triangles.size();
  erase_marked(surface.triangles, dropped);
  return before - surface.triangles.size();
}

}  // namespace sixdof::repairing
