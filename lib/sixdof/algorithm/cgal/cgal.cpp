#include <sixdof/algorithm/cgal/cgal.h>

#include <array>
#include <exception>
#include <string>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/version_macros.h>

#include <sixdof/algorithm/volume_response.h>
#include <sixdof/base/error.h>
#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/solid.h>

namespace sixdof {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = Surface::Face_index;
using Vertex = Surface::Vertex_index;

/// @throws BadMesh if CGAL cannot represent it
Surface to_cgal(const Mesh& mesh) {
  Surface surface;
  for (const Eigen::Vector3d& v : mesh.vertices()) surface.add_vertex({v.x(), v.y(), v.z()});
  for (const Triangle& t : mesh.triangles()) {
    if (surface.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])) == Surface::null_face()) {
      throw BadMesh(mesh.name() + ": CGAL takes manifold, consistently oriented meshes only");
    }
  }
  return surface;
}

/// Remembers which faces of a result are B's.
struct FacesOfB : CGAL::Polygon_mesh_processing::Corefinement::Default_visitor<Surface> {
  FacesOfB(const Surface& surface_b, std::vector<Face>& faces) : b(&surface_b), faces_of_b(&faces) {}
  void after_face_copy(Face /*old_face*/, const Surface& surface, Face new_face, const Surface& /*output*/) {
    if (&surface == b) faces_of_b->push_back(new_face);
  }
  const Surface* b;
  std::vector<Face>* faces_of_b;
};

class CgalQuery final : public Query {
 public:
  CgalQuery(const Mesh& a, const Mesh& b, const Settings& /*settings*/)
      : mesh_b_(b), a_(to_cgal(a)), b_(to_cgal(b)), id_a_(detection_.add_mesh(a_)), id_b_(detection_.add_mesh(b_)) {
    for (const Mesh* mesh : {&a, &b}) {
      if (!mesh->solid()) why_no_response_ = mesh->name() + ": " + mesh->why_not_solid() + k_repair_hint;
    }
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    const Eigen::Matrix3d& R = X_AB.R;
    const Eigen::Vector3d& t = X_AB.t;
    try {
      detection_.set_transformation(id_b_, {R(0, 0), R(0, 1), R(0, 2), t.x(), R(1, 0), R(1, 1), R(1, 2), t.y(), R(2, 0),
                                            R(2, 1), R(2, 2), t.z()});
      return !detection_.get_all_intersections(id_b_).empty();
    } catch (const std::exception& e) {
      return fail(Status::failed, e.what());
    }
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    if (!why_no_response_.empty()) return fail(Status::failed, why_no_response_);
    try {
      return intersection(X_AB);
    } catch (const std::exception& e) {
      return fail(Status::failed, e.what());
    }
  }

  /// CGAL does not tell the size of its trees.
  Footprint footprint() const override {
    return {0, {{"triangles", static_cast<double>(a_.number_of_faces() + b_.number_of_faces())}}};
  }

 private:
  Outcome<Response> intersection(const Pose& X_AB) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    Surface a = a_, b = b_, common;
    for (const Vertex v : b.vertices()) {
      const Eigen::Vector3d p = transform_point(X_AB, mesh_b_.vertices()[v]);
      b.point(v) = {p.x(), p.y(), p.z()};
    }
    std::vector<Face> faces_of_b;
    if (!pmp::corefine_and_compute_intersection(a, b, common, CGAL::parameters::visitor(FacesOfB(b, faces_of_b)))) {
      return fail(Status::failed, "the intersection has no manifold boundary");
    }
    std::vector<bool> is_of_b(common.num_faces(), false);
    for (const Face f : faces_of_b) is_of_b[f] = true;
    VolumeResponse sum(X_AB * mesh_b_.center());
    for (const Face f : common.faces()) {
      std::array<Eigen::Vector3d, 3> corners;
      int i = 0;
      for (const Vertex v : common.vertices_around_face(common.halfedge(f))) {
        const auto& p = common.point(v);
        corners[i++] = {p.x(), p.y(), p.z()};
      }
      sum.add(corners[0], corners[1], corners[2], is_of_b[f]);
    }
    return sum.response();
  }

  const Mesh& mesh_b_;
  const Surface a_, b_;
  CGAL::Rigid_triangle_mesh_collision_detection<Surface> detection_;
  const std::size_t id_a_, id_b_;
  std::string why_no_response_;
};

}  // namespace

std::unique_ptr<Algorithm> make_cgal_algorithm() {
  return make_algorithm<CgalQuery>(
      {.name = "cgal",
       .version = CGAL_VERSION_STR " (GPL)",
       .summary = "CGAL (GPL): yes/no of moving meshes; volume of the intersection by corefinement, and its gradient",
       .answers = {.collide = true, .respond = true},
       .law = ResponseLaw::volume,
       .limits = {.surfaces_only = {.collide = true}},
       .by_default = false});
}

void register_cgal_algorithms(Registry& registry) { registry.add(make_cgal_algorithm()); }

}  // namespace sixdof
