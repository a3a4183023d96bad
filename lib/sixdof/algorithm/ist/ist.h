#pragma once

#include <memory>

#include <sixdof/query/algorithm.h>
#include <sixdof/algorithm/ist/hierarchy.h>

namespace sixdof {

/// `ist`: inner sphere trees (Weller and Zachmann 2009). Both solids are filled with disjoint spheres; the penalty is
/// the summed volume of the overlaps of spheres of A with spheres of B, the force acts along the lines of their
/// centres.
///
/// The spheres fill only a part of each solid (the fill rate, a count of the footprint), so volume and force are biased
/// low and distances high. Parameter `correct_fill=on` divides volume and force by both fill rates; `correct_fill=cells` lets
/// each sphere count for the part of the solid that is nearest to it (cells.h), so that a volume is right wherever it
/// is, not on average over the body. `collide` and `distance` answer for the spheres, not the surfaces.
///
/// With `force=gradient` the force is minus the gradient of that volume and approaches the exact one as spheres grow in
/// number, in direction and (corrected) in magnitude; with `force=volume`, the paper's, the direction keeps an error.
/// `force=descent` has the volume as magnitude, as the paper's law asks, and the gradient's direction (descent.h).
std::unique_ptr<Algorithm> make_ist_algorithm();

namespace ist {

/// A packed solid with its hierarchy.
struct InnerSphereTree {
  SphereTree tree;
  double fill = 0.0;  ///< Share of the solid's volume that the spheres fill.
};

/// Packs and builds with the settings of `ist`. @throws BadMesh if the mesh is not solid or too thin.
InnerSphereTree build_inner_sphere_tree(const Mesh& mesh, const Settings& settings);

}  // namespace ist
}  // namespace sixdof
