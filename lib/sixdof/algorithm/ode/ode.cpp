#include <sixdof/algorithm/ode/ode.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <ode/ode.h>

#include <sixdof/algorithm/contact_wrench.h>
#include <sixdof/algorithm/ode/ode_lock.h>
#include <sixdof/base/error.h>

namespace sixdof {
namespace {

constexpr const char* k_max_contacts = "max_contacts";
/// dCollide() has the number in the lower 16 bits of its flags.
constexpr int k_largest_count = 65535;

/// Refers to the arrays of a mesh, which outlives it. Made and destroyed under an OdeLock.
class TriangleData {
 public:
  explicit TriangleData(const Mesh& mesh) : mesh_(checked(mesh)), data_(dGeomTriMeshDataCreate()) {
    dGeomTriMeshDataBuildDouble(data_, mesh.vertices().data(), sizeof(Eigen::Vector3d),
                                static_cast<int>(mesh.vertices().size()), mesh.triangles().data(),
                                3 * static_cast<int>(mesh.triangles().size()), sizeof(Triangle));
  }
  TriangleData(const TriangleData&) = delete;
  TriangleData& operator=(const TriangleData&) = delete;
  ~TriangleData() { dGeomTriMeshDataDestroy(data_); }

  dTriMeshDataID get() const { return data_; }
  const Mesh& mesh() const { return mesh_; }

 private:
  static const Mesh& checked(const Mesh& mesh) {
    constexpr auto k_max_count = static_cast<std::size_t>(std::numeric_limits<int>::max()) / 3;
    if (mesh.triangles().size() > k_max_count || mesh.vertices().size() > k_max_count) {
      throw BadMesh(fmt::format("{}: more triangles or vertices than ODE can count", mesh.name()));
    }
    return mesh;
  }

  static_assert(sizeof(dReal) == sizeof(double), "ODE is compiled for double precision");
  static_assert(sizeof(Triangle) == 3 * sizeof(dTriIndex));
  const Mesh& mesh_;
  const dTriMeshDataID data_;
};

class OdeQuery final : public Query {
 public:
  OdeQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : center_b_(b.center()), wrench_(settings), contacts_(static_cast<std::size_t>(settings.number(k_max_contacts))) {
    // Its trees of one triangle have no nodes. It looks for them where both meshes have such a tree.
    if (a.triangles().size() == 1 && b.triangles().size() == 1) {
      throw BadMesh(fmt::format("{}, {}: ODE cannot collide two meshes of one triangle", a.name(), b.name()));
    }
    const OdeLock lock;
    data_a_ = std::make_shared<TriangleData>(a);
    data_b_ = a.hash() == b.hash() ? data_a_ : std::make_shared<TriangleData>(b);
    geometry_a_ = dCreateTriMesh(nullptr, data_a_->get(), nullptr, nullptr, nullptr);
    geometry_b_ = dCreateTriMesh(nullptr, data_b_->get(), nullptr, nullptr, nullptr);
  }
  OdeQuery(const OdeQuery&) = delete;
  OdeQuery& operator=(const OdeQuery&) = delete;

  ~OdeQuery() override {
    const OdeLock lock;
    dGeomDestroy(geometry_a_);
    dGeomDestroy(geometry_b_);
    data_a_.reset();
    data_b_.reset();
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    const auto [status, count] = find_contacts(X_AB, 1 | static_cast<int>(CONTACTS_UNIMPORTANT));
    if (status != Status::ok) return status;
    return count > 0;
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    const auto [status, count] = find_contacts(X_AB, static_cast<int>(contacts_.size()));
    if (status != Status::ok) return status;
    if (count >= contacts_.size()) return fail(Status::failed, fmt::format("more contacts than {}", contacts_.size()));
    wrench_.reset(X_AB * center_b_);
    for (std::size_t i = 0; i < count; ++i) {
      const dContactGeom& contact = contacts_[i];
      // ODE's normal leads the first body, A, out of the second.
      wrench_.add({contact.pos[0], contact.pos[1], contact.pos[2]},
                  {-contact.normal[0], -contact.normal[1], -contact.normal[2]}, contact.depth);
    }
    const Response response = wrench_.response();
    if (!response.force.allFinite() || !response.torque.allFinite()) {
      return fail(Status::non_finite, "a contact is not finite");
    }
    return response;
  }

  /// ODE does not tell the size of its trees.
  Footprint footprint() const override {
    double triangles = 0.0;
    for (const auto* data : {data_a_.get(), data_a_ == data_b_ ? nullptr : data_b_.get()}) {
      if (data != nullptr) triangles += static_cast<double>(data->mesh().triangles().size());
    }
    return {contacts_.size() * sizeof(dContactGeom), {{"triangles", triangles}}};
  }

 private:
  /// @return how many contacts are in contacts_
  std::pair<Status, std::size_t> find_contacts(const Pose& X_AB, int flags) {
    if (!is_finite(X_AB)) return {fail(Status::failed, "the pose is not finite"), 0};
    try {
      const OdeLock lock;
      dMatrix3 rotation = {};
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) rotation[4 * row + column] = X_AB.R(row, column);
      }
      dGeomSetRotation(geometry_b_, rotation);
      dGeomSetPosition(geometry_b_, X_AB.t.x(), X_AB.t.y(), X_AB.t.z());
      const int count = dCollide(geometry_a_, geometry_b_, flags, contacts_.data(), sizeof(dContactGeom));
      return {Status::ok, static_cast<std::size_t>(count)};
    } catch (const std::exception& e) {
      return {fail(Status::failed, e.what()), 0};
    }
  }

  const Eigen::Vector3d center_b_;
  ContactWrench wrench_;
  std::vector<dContactGeom> contacts_;
  std::shared_ptr<const TriangleData> data_a_, data_b_;
  dGeomID geometry_a_ = nullptr, geometry_b_ = nullptr;
};

}  // namespace

std::unique_ptr<Algorithm> make_ode_algorithm() {
  return make_algorithm<OdeQuery>(
      {.name = "ode",
       .version = SIXDOF_ODE_VERSION " double",
       .summary = "ODE with OPCODE: contacts of triangle pairs as a penalty wrench",
       .answers = {.collide = true, .respond = true},
       .law = ResponseLaw::depth,
       .limits = {.surfaces_only = {.collide = true, .respond = true}, .own_direction = true},
       .parameters = {ContactWrench::combine_parameter(), max_contacts_parameter("65535", k_largest_count)}});
}

void register_ode_algorithms(Registry& registry) { registry.add(make_ode_algorithm()); }

}  // namespace sixdof
