// The distance of two meshes as they lie in their files: distance_of_two_files A B
#include <cstdio>
#include <exception>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/geometry/load.h>
#include <sixdof/query/registry.h>

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const sixdof::Mesh a = sixdof::load_mesh(argv[1]), b = sixdof::load_mesh(argv[2]);

  sixdof::Registry registry;
  sixdof::register_core_algorithms(registry);
  const sixdof::Algorithm& exact = registry.find("exact");
  const auto query = exact.prepare(a, b, exact.settings());  // builds its structures; a and b must outlive it

  const sixdof::Pose X_AB{};  // the identity: both files use one frame
  const sixdof::Outcome<sixdof::Separation> answer = query->distance(X_AB);
  if (!answer.ok()) {
    std::fprintf(stderr, "no answer: %s\n", query->diagnosis().c_str());
    return 1;
  }
  const Eigen::Vector3d& p = answer.value.witness_a;  // in A's frame
  std::printf("%.17g, closest to B at %g %g %g\n", answer.value.distance, p.x(), p.y(), p.z());
  return 0;
} catch (const std::exception& e) {  // a file that cannot be read: BadFile, BadMesh
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
