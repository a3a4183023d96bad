#include <sixdof/algorithm/ode/ode.h>

#include <algorithm>
#include <span>
#include <vector>

#include <sixdof/algorithm/ode/ode_lock.h>
#include <sixdof/algorithm/ode/ode_mesh.h>

namespace sixdof {
namespace {

constexpr const char* k_max_contacts = "max_contacts";
/// dCollide() has the number in the lower 16 bits of its flags.
constexpr int k_largest_count = 65535;

class OdeQuery final : public LibraryQuery {
 public:
  OdeQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : center_b_(b.center()), wrench_(settings), contacts_(static_cast<std::size_t>(settings.number(k_max_contacts))) {
    // Its trees of one triangle have no nodes. It looks for them where both meshes have such a tree.
    if (a.triangles().size() == 1 && b.triangles().size() == 1) {
      throw BadMesh(fmt::format("{}, {}: ODE cannot collide two meshes of one triangle", a.name(), b.name()));
    }
    const OdeLock lock;
    meshes_ = ShapePair<OdeMesh>::of(a, b, [](const Mesh& mesh) { return std::make_shared<OdeMesh>(mesh); });
    geometry_a_ = meshes_.a->new_geometry();
    geometry_b_ = meshes_.b->new_geometry();
  }
  OdeQuery(const OdeQuery&) = delete;
  OdeQuery& operator=(const OdeQuery&) = delete;

  ~OdeQuery() override {
    const OdeLock lock;
    dGeomDestroy(geometry_a_);
    dGeomDestroy(geometry_b_);
    meshes_ = {};
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    const Outcome<std::size_t> count = find_contacts(X_AB, 1 | static_cast<int>(CONTACTS_UNIMPORTANT));
    if (!count.ok()) return count.status;
    return count.value > 0;
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    const Outcome<std::size_t> count = find_contacts(X_AB, static_cast<int>(contacts_.size()));
    if (!count.ok()) return count.status;
    if (count.value >= contacts_.size()) return too_many_contacts(contacts_.size());
    wrench_.reset(X_AB * center_b_);
    for (std::size_t i = 0; i < count.value; ++i) {
      const dContactGeom& contact = contacts_[i];
      // ODE's normal leads the first body, A, out of the second.
      wrench_.add({contact.pos[0], contact.pos[1], contact.pos[2]},
                  {-contact.normal[0], -contact.normal[1], -contact.normal[2]}, contact.depth);
    }
    return response_of(wrench_);
  }

  /// ODE keeps the first that it finds.
  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override {
    const std::size_t asked = std::min(most, contacts_.size());
    if (asked == 0) return Contacts{};
    const Outcome<std::size_t> count = find_contacts(X_AB, static_cast<int>(asked));
    if (!count.ok()) return count.status;
    Contacts found;
    for (const dContactGeom& contact : std::span(contacts_).first(std::min(count.value, asked))) {
      // ODE's normal leads the first body, A, out of the second.
      found.list.push_back({{contact.pos[0], contact.pos[1], contact.pos[2]},
                            {-contact.normal[0], -contact.normal[1], -contact.normal[2]},
                            contact.depth});
    }
    return found;
  }

  /// ODE does not tell the size of its trees.
  Footprint footprint() const override {
    double triangles = 0.0;
    meshes_.for_each([&](const OdeMesh& each) { triangles += static_cast<double>(each.mesh().triangles().size()); });
    return {contacts_.size() * sizeof(dContactGeom), {{"triangles", triangles}}};
  }

 private:
  /// How many contacts are in contacts_ now.
  Outcome<std::size_t> find_contacts(const Pose& X_AB, int flags) {
    return guarded(X_AB, [&]() -> Outcome<std::size_t> {
      const OdeLock lock;
      place(geometry_b_, X_AB);
      return static_cast<std::size_t>(
          dCollide(geometry_a_, geometry_b_, flags, contacts_.data(), sizeof(dContactGeom)));
    });
  }

  const Eigen::Vector3d center_b_;
  ContactWrench wrench_;
  std::vector<dContactGeom> contacts_;
  ShapePair<OdeMesh> meshes_;
  dGeomID geometry_a_ = nullptr, geometry_b_ = nullptr;
};

}  // namespace

std::unique_ptr<Algorithm> make_ode_algorithm() {
  return make_algorithm<OdeQuery>(
      {.name = "ode",
       .version = SIXDOF_ODE_VERSION " double",
       .summary = "ODE with OPCODE: contacts of triangle pairs as a penalty wrench",
       .answers = {.collide = true, .respond = true, .contacts = true},
       .law = ResponseLaw::contacts,
       .depth = ContactDepth::triangles,
       .limits = {.surfaces_only = {.collide = true, .respond = true}, .own_direction = true},
       .parameters = {ContactWrench::combine_parameter(), max_contacts_parameter("65535", k_largest_count)}});
}

void register_ode_algorithms(Registry& registry) { registry.add(make_ode_algorithm()); }

}  // namespace sixdof
