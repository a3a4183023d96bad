#include <sixdof/models/lattice.h>

#include <unordered_map>

#include <sixdof/models/fixed_order.h>

namespace sixdof {
namespace {

/// The wall of a solid cell towards lower or higher numbers on `axis`.
struct Wall {
  Lattice::Node cell;
  std::size_t axis;
  bool towards_higher;
};

template <class Body>
void for_each_wall(const Lattice& lattice, Body body) {
  const std::array<std::uint32_t, 3> size{static_cast<std::uint32_t>(lattice.steps[0].size()),
                                          static_cast<std::uint32_t>(lattice.steps[1].size()),
                                          static_cast<std::uint32_t>(lattice.steps[2].size())};
  Lattice::Node cell;
  for (cell[0] = 0; cell[0] < size[0]; ++cell[0]) {
    for (cell[1] = 0; cell[1] < size[1]; ++cell[1]) {
      for (cell[2] = 0; cell[2] < size[2]; ++cell[2]) {
        if (!lattice.solid(cell)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const bool towards_higher : {false, true}) {
            const bool closes = lattice.ring && axis == 1;
            const bool at_end = towards_higher ? cell[axis] + 1 == size[axis] : cell[axis] == 0;
            Lattice::Node beyond = cell;
            beyond[axis] = (cell[axis] + (towards_higher ? 1 : size[axis] - 1)) % size[axis];
            if ((at_end && !closes) || !lattice.solid(beyond)) body(Wall{cell, axis, towards_higher});
          }
        }
      }
    }
  }
}

double distance_squared(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = a - b;
  return dot_in_order(along, along);
}

class Builder {
 public:
  explicit Builder(const Lattice& lattice) : lattice_(lattice) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      start_[axis].push_back(0);
      for (const std::uint32_t s : lattice.steps[axis]) start_[axis].push_back(start_[axis].back() + s);
    }
  }

  void add(const Wall& wall) {
    const std::size_t u = (wall.axis + 1) % 3;
    const std::size_t v = (wall.axis + 2) % 3;
    Lattice::Node node;
    node[wall.axis] = start_[wall.axis][wall.cell[wall.axis] + (wall.towards_higher ? 1 : 0)];
    for (std::uint32_t i = start_[u][wall.cell[u]]; i < start_[u][wall.cell[u] + 1]; ++i) {
      for (std::uint32_t j = start_[v][wall.cell[v]]; j < start_[v][wall.cell[v] + 1]; ++j) {
        const auto corner = [&](std::uint32_t di, std::uint32_t dj) {
          node[u] = i + di;
          node[v] = j + dj;
          return vertex(node);
        };
        const std::uint32_t a = corner(0, 0);
        const std::uint32_t b = corner(1, 0);
        const std::uint32_t c = corner(1, 1);
        const std::uint32_t d = corner(0, 1);
        wall.towards_higher ? add_quad(a, b, c, d) : add_quad(a, d, c, b);
      }
    }
  }

  Surface take() { return std::move(surface_); }

 private:
  std::uint32_t vertex(Lattice::Node node) {
    if (lattice_.ring && node[1] == start_[1].back()) node[1] = 0;
    const std::uint64_t width = start_[2].back() + 1ULL;
    const std::uint64_t key = (node[0] * (start_[1].back() + 1ULL) + node[1]) * width + node[2];
    const auto [entry, fresh] = numbers_.try_emplace(key, static_cast<std::uint32_t>(surface_.vertices.size()));
    if (fresh) surface_.vertices.push_back(lattice_.position(node));
    return entry->second;
  }

  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const auto& p = surface_.vertices;
    if (distance_squared(p[a], p[c]) <= distance_squared(p[b], p[d])) {
      surface_.triangles.push_back({a, b, c});
      surface_.triangles.push_back({a, c, d});
    } else {
      surface_.triangles.push_back({b, c, d});
      surface_.triangles.push_back({b, d, a});
    }
  }

  const Lattice& lattice_;
  std::array<std::vector<std::uint32_t>, 3> start_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
  Surface surface_;
};

}  // namespace

std::size_t count_triangles(const Lattice& lattice) {
  std::size_t sum = 0;
  for_each_wall(lattice, [&](const Wall& wall) {
    const std::size_t u = (wall.axis + 1) % 3;
    const std::size_t v = (wall.axis + 2) % 3;
    sum += 2ULL * lattice.steps[u][wall.cell[u]] * lattice.steps[v][wall.cell[v]];
  });
  return sum;
}

Surface surface_of(const Lattice& lattice) {
  Builder builder(lattice);
  for_each_wall(lattice, [&](const Wall& wall) { builder.add(wall); });
  return builder.take();
}

}  // namespace sixdof
