// An external program: a mesh, the registry and one query through the installed headers and libraries.
#include <cstdio>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/query/registry.h>

int main() {
  const sixdof::Mesh tetrahedron =
      sixdof::Mesh::build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  sixdof::Registry registry;
  sixdof::register_core_algorithms(registry);
  const auto& algorithm = registry.find("null");
  const auto query = algorithm.prepare(tetrahedron, tetrahedron, algorithm.settings());
  const bool right = tetrahedron.solid() && query->collide(sixdof::Pose{}).ok();
  std::printf("%s\n", right ? "ok" : "wrong");
  return right ? 0 : 1;
}
