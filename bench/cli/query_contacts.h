#pragma once

#include <nlohmann/json.hpp>

#include <sixdof/geometry/mesh.h>
#include <sixdof/query/algorithm.h>

namespace sixdof::cli {

/// A list with an object for each contact: point, normal and depth as the algorithm gives them and, where both meshes
/// are solid, what exact geometry says (oracle/contact_truth.h): `off`, the distance of the point from being in both
/// bodies, `normal_degrees`, the angle to the nearest true normal, and `thickness`, what the depth should be.
nlohmann::ordered_json describe_contacts(const Contacts& contacts, const Mesh& a, const Mesh& b, const Pose& X_AB);

}  // namespace sixdof::cli
