#pragma once

#include <memory>

#include <sixdof/algorithm/ist/hierarchy.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

/// `ist`: inner sphere trees (Weller and Zachmann, "A Unified Approach for Physically-Based Simulations and Haptic
/// Rendering", 2009; Weller, "New Geometric Data Structures for Collision Detection and Haptics", 2013). Both solids
/// are packed with disjoint spheres. The penalty is the sum of the overlap volumes of spheres of A with spheres of B;
/// each pair's force has that volume as magnitude and acts along the axes of the spheres' normal cones (normal_cone.h).
///
/// The spheres fill only a fraction of each solid (the fill rate, a count of the footprint), so volume and force are
/// too small and distances too large. `correct_fill=on` divides volume and force by both fill rates.
/// `correct_fill=cells` weights each sphere with the part of the solid that is nearest to it (packing.h), which
/// corrects the volume locally. `collide` and `distance` answer for the spheres, not for the surfaces.
///
/// Parameter `force`: PairForce (traversal.h); the algorithms' README compares them.
std::unique_ptr<Algorithm> make_ist_algorithm();

/// `ist-descent`: the same spheres with another response, which is this project's own. The summed volume, each sphere
/// weighted with the part of the solid that is nearest to it, is the magnitude; its direction is that in which this
/// volume decreases fastest (steepest_descent() in traversal.h).
std::unique_ptr<Algorithm> make_ist_descent_algorithm();

namespace ist {

/// A packed solid with its hierarchy.
struct InnerSphereTree {
  SphereTree tree;    ///< Spheres and their hierarchy, in the mesh's frame.
  double fill = 0.0;  ///< Fraction of the solid's volume that the spheres fill.
};

/// Packs and builds body A's tree with the settings of `ist`. @throws BadMesh if the mesh is not solid or too thin.
InnerSphereTree build_inner_sphere_tree(const Mesh& mesh, const Settings& settings);

}  // namespace ist
}  // namespace sixdof
