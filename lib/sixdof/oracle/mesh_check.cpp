#include <sixdof/oracle/mesh_check.h>

#include <optional>

#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/shells.h>

namespace sixdof {
namespace {

struct Corners {
  Eigen::Vector3d a, b, c;

  Corners(const Mesh& mesh, std::uint32_t t)
      : a(mesh.vertices()[mesh.triangles()[t][0]]),
        b(mesh.vertices()[mesh.triangles()[t][1]]),
        c(mesh.vertices()[mesh.triangles()[t][2]]) {}
  double twice_area() const { return (b - a).cross(c - a).norm(); }
  Eigen::Vector3d middle() const { return (a + b + c) / 3.0; }
};

/// For each shell its largest triangle that is in no contact.
std::vector<std::optional<std::uint32_t>> samples_of(const Mesh& mesh, const Shells& shells,
                                                     const std::vector<std::uint8_t>& touched) {
  std::vector<std::optional<std::uint32_t>> samples(shells.all.size());
  std::vector<double> largest(shells.all.size(), 0.0);
  for (std::uint32_t t = 0; t < touched.size(); ++t) {
    const std::uint32_t s = shells.of_triangle[t];
    const double size = Corners(mesh, t).twice_area();
    if (touched[t] != 0 || size <= largest[s]) continue;
    largest[s] = size;
    samples[s] = t;
  }
  return samples;
}

/// Winding number in front of a triangle of shell `s`: that of the other closed shells, and -1 inside of a shell that
/// faces inwards.
int winding_in_front(const Tree& tree, const Shells& shells, std::uint32_t s, const Eigen::Vector3d& p) {
  int sum = shells.all[s].volume < 0.0 ? -1 : 0;
  for (const auto& [other, winding] : windings_of_groups(tree, shells.of_triangle, p)) {
    if (other != s && shells.all[other].closed) sum += winding;
  }
  return sum;
}

void add(MeshCheck& check, const Mesh& mesh, const Shell& shell, ShellDefect defect, std::uint32_t triangle,
         int layers) {
  std::size_t& count = defect == ShellDefect::doubled  ? check.doubled
                       : defect == ShellDefect::nested ? check.nested
                                                       : check.inverted;
  ++count;
  if (check.first.size() == MeshCheck::k_listed) return;
  check.first.push_back({.defect = defect,
                         .triangle = triangle,
                         .point = Corners(mesh, triangle).middle(),
                         .layers = layers,
                         .triangles = shell.triangles});
}

/// 1 for each shell in contact with another.
std::vector<std::uint8_t> meeting_others(const Shells& shells, const std::vector<std::uint8_t>& touched) {
  std::vector<std::uint8_t> meeting(shells.all.size(), 0);
  for (std::size_t t = 0; t < touched.size(); ++t) {
    if ((touched[t] & SelfContacts::k_across) != 0) meeting[shells.of_triangle[t]] = 1;
  }
  return meeting;
}

void check_shells(const Mesh& mesh, const Tree& tree, const Shells& shells, const RunOptions& options,
                  MeshCheck& check) {
  const auto meeting = meeting_others(shells, check.contacts.touched);
  const auto samples = samples_of(mesh, shells, check.contacts.touched);
  check.shells = shells.all.size();
  for (std::uint32_t s = 0; s < shells.all.size(); ++s) {
    options.check_cancelled();
    const Shell& shell = shells.all[s];
    if (!shell.closed) {
      ++check.open_shells;
    } else if (shell.doubled) {
      add(check, mesh, shell, ShellDefect::doubled, shell.first_triangle, 0);
    } else if (meeting[s] != 0) {
      ++check.meeting;
    } else if (!samples[s]) {
      ++check.undecided;
    } else {
      const int front = winding_in_front(tree, shells, s, Corners(mesh, *samples[s]).middle());
      if (front > 0) add(check, mesh, shell, ShellDefect::nested, *samples[s], front + 1);
      if (front < 0) add(check, mesh, shell, ShellDefect::inverted, *samples[s], front);
    }
  }
}

}  // namespace

MeshCheck check_mesh(const Mesh& mesh, const RunOptions& options) {
  const Tree tree(mesh);
  MeshCheck check;
  const Shells shells = find_shells(mesh);
  check.contacts = find_self_contacts(mesh, tree, shells.of_triangle, options);
  check_shells(mesh, tree, shells, options, check);
  return check;
}

}  // namespace sixdof
