#pragma once

#include <array>
#include <limits>
#include <vector>

#include <coal/BVH/BVH_model.h>
#include <fcl/narrowphase/collision.h>

namespace coal {

enum class GJKInitialGuess {
  DefaultGuess,
  CachedGuess
};

/// As Coal's, it has the guess that it handed out and counts how often it was updated.
struct QueryResult {
  Vec3s cached_gjk_guess = Vec3s::Zero();
};
struct QueryRequest {
  GJKInitialGuess gjk_initial_guess = GJKInitialGuess::DefaultGuess;
  void updateGuess(const QueryResult& /*result*/) const { ++updates(); }
  static int& updates() {
    static int count = 0;
    return count;
  }
};

/// Coal's depth is a signed distance: negative inside.
struct Contact {
  Vec3s normal, pos;
  double penetration_depth;
};

struct CollisionRequest : QueryRequest {
  std::size_t num_max_contacts = 1;
  bool enable_contact = true;
};

class CollisionResult : public QueryResult {
 public:
  bool isCollision() const { return !contacts.empty(); }
  std::size_t numContacts() const { return contacts.size(); }
  const Contact& getContact(std::size_t i) const { return contacts[i]; }
  std::vector<Contact> contacts;
};

inline std::size_t collide(const CollisionGeometry* a, const Transform3s& X_a, const CollisionGeometry* b,
                           const Transform3s& X_b, const CollisionRequest& request, CollisionResult& result) {
  fcl::CollisionResultd found;
  fcl::collide<double>(&a->model, X_a.fcl(), &b->model, X_b.fcl(),
                       fcl::CollisionRequestd(request.num_max_contacts, request.enable_contact), found);
  for (std::size_t i = 0; i < found.numContacts(); ++i) {
    const fcl::Contactd& contact = found.getContact(i);
    result.contacts.push_back({contact.normal, contact.pos, -contact.penetration_depth});
  }
  return result.contacts.size();
}

class ComputeCollision {
 public:
  ComputeCollision(const CollisionGeometry* a, const CollisionGeometry* b) : a_(a), b_(b) {}
  std::size_t operator()(const Transform3s& X_a, const Transform3s& X_b, const CollisionRequest& request,
                         CollisionResult& result) const {
    return collide(a_, X_a, b_, X_b, request, result);
  }

 private:
  const CollisionGeometry *a_, *b_;
};

}  // namespace coal
