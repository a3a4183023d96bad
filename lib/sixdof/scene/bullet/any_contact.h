#pragma once

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

namespace sixdof::scene {

/// Whether there is any contact.
class AnyContact final : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;
  void addContactPoint(const btVector3& /*normal*/, const btVector3& /*point*/, btScalar /*distance*/) override {
    found = true;
  }
  bool found = false;  ///< So far.
};

}  // namespace sixdof::scene
