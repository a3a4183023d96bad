#pragma once

#include <cstddef>
#include <exception>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include <sixdof/algorithm/contact_wrench.h>
#include <sixdof/base/error.h>
#include <sixdof/query/algorithm.h>

/// Shared by the adapters of other libraries.

namespace sixdof {

/// @param per what the library counts in int for each triangle or vertex
/// @throws BadMesh if those of the mesh are too many
inline void require_countable(const Mesh& mesh, const char* library, std::size_t per) {
  const std::size_t most = static_cast<std::size_t>(std::numeric_limits<int>::max()) / per;
  if (mesh.triangles().size() > most || mesh.vertices().size() > most) {
    throw BadMesh(fmt::format("{}: more triangles or vertices than {} can count", mesh.name(), library));
  }
}

/// What a library made of the meshes of two bodies. Equal meshes share one.
template <class Shape>
struct ShapePair {
  std::shared_ptr<const Shape> a, b;

  /// @param build returns the std::shared_ptr of a mesh's
  template <class Build>
  static ShapePair of(const Mesh& a, const Mesh& b, const Build& build) {
    const std::shared_ptr<const Shape> first = build(a);
    return {first, a.hash() == b.hash() ? first : build(b)};
  }

  /// Calls visit() for each of the one or two.
  template <class Visit>
  void for_each(const Visit& visit) const {
    visit(*a);
    if (a != b) visit(*b);
  }
};

class LibraryQuery : public Query {
 protected:
  /// answer(); a failure if it throws, or if the pose is not finite: a library may find no two volumes apart and expand
  /// all of its trees.
  template <class Answer>
  auto guarded(const Pose& X_AB, const Answer& answer) -> decltype(answer()) {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    try {
      return answer();
    } catch (const std::exception& e) {
      return fail(Status::failed, e.what());
    }
  }

  Outcome<Response> response_of(const ContactWrench& contacts) {
    const Response response = contacts.response();
    if (response.force.allFinite() && response.torque.allFinite()) return response;
    return fail(Status::non_finite, "a contact is not finite");
  }

  Status too_many_contacts(std::size_t most) {
    return fail(Status::failed, fmt::format("more contacts than {}", most));
  }
};

}  // namespace sixdof
