// The buckets of a configuration set, and the first pose of each: read_set FILE A B, with the set's meshes
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <vector>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/geometry/load.h>

int main(int argc, char** argv) try {
  if (argc != 4) return 2;
  const sixdof::ConfigurationSet set(argv[1]);
  const sixdof::Mesh a = sixdof::load_mesh(argv[2]), b = sixdof::load_mesh(argv[3]);
  set.check_meshes(a, b);

  for (const sixdof::BucketSummary& bucket : set.buckets()) {
    const sixdof::Grid& grid = set.grid(bucket.key.kind);
    const std::vector<double> translations = set.read(bucket.key);  // [rotation][direction], NaN: unreachable
    std::size_t cell = 0;
    while (cell < translations.size() && std::isnan(translations[cell])) ++cell;
    std::printf("%s: %llu of %zu reachable", bucket.key.name().c_str(),
                static_cast<unsigned long long>(bucket.reachable), translations.size());
    if (cell < translations.size()) {
      const std::size_t rotation = cell / grid.directions.size(), direction = cell % grid.directions.size();
      const sixdof::ConfigurationRay ray(a, b, grid.rotations[rotation], grid.directions[direction]);
      const sixdof::Pose X_AB = ray.pose(translations[cell]);
      std::printf(", the first at %g %g %g", X_AB.t.x(), X_AB.t.y(), X_AB.t.z());
    }
    std::printf("\n");
  }
  return 0;
} catch (const std::exception& e) {  // BadFile, BadMesh; BadArgument for other meshes than the set's
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
