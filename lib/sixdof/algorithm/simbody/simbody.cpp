#include <sixdof/algorithm/simbody/simbody.h>

#include <cmath>
#include <exception>

#include <sixdof/algorithm/library_query.h>
#include <sixdof/algorithm/simbody/foundation.h>

namespace sixdof {
namespace {

/// Simbody halves the areas where both bodies have springs.
constexpr double k_area_factor = 0.5;

Foundation::Surface surface_of(const Mesh& mesh) {
  Foundation::Surface surface;
  for (const Eigen::Vector3d& v : mesh.vertices())
    surface.vertices.insert(surface.vertices.end(), {v.x(), v.y(), v.z()});
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t i : t) surface.corners.push_back(static_cast<int>(i));
  }
  return surface;
}

/// @throws BadMesh if Simbody refuses one of the meshes
std::unique_ptr<Foundation> foundation_of(const Mesh& a, const Mesh& b) {
  for (const Mesh* mesh : {&a, &b}) {
    const MeshTopology& topology = mesh->topology();
    if (!topology.closed || !topology.manifold || !topology.oriented) {
      throw BadMesh(mesh->name() + ": simbody needs a closed, manifold, consistently oriented mesh");
    }
  }
  try {
    return std::make_unique<Foundation>(surface_of(a), surface_of(b));
  } catch (const std::exception& e) {
    throw BadMesh(a.name() + ", " + b.name() + ": Simbody refuses a mesh: " + e.what());
  }
}

class SimbodyQuery final : public LibraryQuery {
 public:
  SimbodyQuery(const Mesh& a, const Mesh& b, const Settings& /*settings*/)
      : center_b_(b.center()),
        area_(a.area() + b.area()),
        triangles_(static_cast<double>(a.triangles().size() + b.triangles().size())),
        foundation_(foundation_of(a, b)) {}

  Outcome<bool> collide(const Pose& X_AB) override {
    return guarded(X_AB, [&]() -> Outcome<bool> { return foundation_->contact(rows(X_AB.R), coordinates(X_AB.t)); });
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    return guarded(X_AB, [&]() -> Outcome<Response> {
      const Foundation::Forces forces = foundation_->forces(rows(X_AB.R), coordinates(X_AB.t));
      Response response{.penalty = std::sqrt(2.0 * forces.energy / (k_area_factor * area_)),
                        .force = {forces.force[0], forces.force[1], forces.force[2]},
                        .torque = {forces.torque[0], forces.torque[1], forces.torque[2]},
                        .reference = X_AB.t};
      if (!response.force.allFinite() || !response.torque.allFinite() || !std::isfinite(response.penalty)) {
        return fail(Status::non_finite, "the force is not finite");
      }
      return response.about(X_AB * center_b_);
    });
  }

  /// Simbody does not tell the size of its trees.
  Footprint footprint() const override { return {0, {{"triangles", triangles_}}}; }

 private:
  static std::array<double, 9> rows(const Eigen::Matrix3d& R) {
    return {R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)};
  }
  static std::array<double, 3> coordinates(const Eigen::Vector3d& t) { return {t.x(), t.y(), t.z()}; }

  const Eigen::Vector3d center_b_;
  const double area_, triangles_;
  const std::unique_ptr<Foundation> foundation_;
};

}  // namespace

std::unique_ptr<Algorithm> make_simbody_algorithm() {
  return make_algorithm<SimbodyQuery>(
      {.name = "simbody",
       .version = SIXDOF_SIMBODY_VERSION " double",
       .summary = "Simbody's elastic foundation: a spring on each triangle of both meshes",
       .answers = {.collide = true, .respond = true},
       .law = ResponseLaw::contacts,
       .limits = {.surfaces_only = {.collide = true, .respond = true}, .own_direction = true},
       .by_default = false});
}

void register_simbody_algorithms(Registry& registry) { registry.add(make_simbody_algorithm()); }

}  // namespace sixdof
