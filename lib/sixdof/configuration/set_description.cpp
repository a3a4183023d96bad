#include <sixdof/configuration/set_description.h>

namespace sixdof {

MeshIdentity MeshIdentity::of(const Mesh& mesh) {
  return {.name = mesh.name(),
          .hash = mesh.hash(),
          .triangles = mesh.triangles().size(),
          .box_min = mesh.box().min(),
          .box_max = mesh.box().max(),
          .volume = mesh.volume()};
}

}  // namespace sixdof
