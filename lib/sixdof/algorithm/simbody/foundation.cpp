#include <sixdof/algorithm/simbody/foundation.h>

#include <Simbody.h>

namespace sixdof {
namespace {

constexpr double k_stiffness = 1.0;

SimTK::ContactGeometry::TriangleMesh to_simbody(const Foundation::Surface& surface) {
  SimTK::Array_<SimTK::Vec3> vertices;
  for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
    vertices.push_back({surface.vertices[i], surface.vertices[i + 1], surface.vertices[i + 2]});
  }
  const SimTK::Array_<int> corners(surface.corners);
  return SimTK::ContactGeometry::TriangleMesh(vertices, corners);
}

}  // namespace

/// As in the documentation of ElasticFoundationForce: a set of contacts with both meshes, A fixed to the ground.
struct Foundation::System {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralContactSubsystem contacts{system};
  SimTK::GeneralForceSubsystem forces{system};
  SimTK::ContactSetIndex set = contacts.createContactSet();
  SimTK::MobilizedBody::Free body_b;
  SimTK::State state;
};

Foundation::Foundation(const Surface& a, const Surface& b) : system_(std::make_unique<System>()) {
  System& s = *system_;
  // Mass is of no account for forces at rest.
  const SimTK::Body::Rigid body(SimTK::MassProperties(1.0, SimTK::Vec3(0.0), SimTK::Inertia(1.0)));
  s.body_b = SimTK::MobilizedBody::Free(s.matter.Ground(), SimTK::Transform(), body, SimTK::Transform());
  s.contacts.addBody(s.set, s.matter.Ground(), to_simbody(a), SimTK::Transform());
  s.contacts.addBody(s.set, s.body_b, to_simbody(b), SimTK::Transform());
  SimTK::ElasticFoundationForce springs(s.forces, s.contacts, s.set);
  for (int i = 0; i < 2; ++i) springs.setBodyParameters(SimTK::ContactSurfaceIndex(i), k_stiffness, 0.0, 0.0, 0.0, 0.0);
  s.state = s.system.realizeTopology();
  s.system.realizeModel(s.state);
}

Foundation::~Foundation() = default;

bool Foundation::contact(const std::array<double, 9>& R, const std::array<double, 3>& t) {
  System& s = *system_;
  // Columns of a rotation matrix; Simbody would otherwise orthogonalise it by its own rule.
  const SimTK::Rotation rotation(SimTK::Mat33(R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8]), true);
  s.body_b.setQToFitTransform(s.state, SimTK::Transform(rotation, SimTK::Vec3(t[0], t[1], t[2])));
  s.system.realize(s.state, SimTK::Stage::Dynamics);
  return !s.contacts.getContacts(s.state, s.set).empty();
}

Foundation::Forces Foundation::forces(const std::array<double, 9>& R, const std::array<double, 3>& t) {
  Forces result;
  result.contact = contact(R, t);
  const System& s = *system_;
  result.energy = s.system.calcPotentialEnergy(s.state);
  const SimTK::SpatialVec wrench =
      s.system.getRigidBodyForces(s.state, SimTK::Stage::Dynamics)[s.body_b.getMobilizedBodyIndex()];
  for (int i = 0; i < 3; ++i) {
    result.torque[static_cast<std::size_t>(i)] = wrench[0][i];
    result.force[static_cast<std::size_t>(i)] = wrench[1][i];
  }
  return result;
}

}  // namespace sixdof
