#pragma once

#include <memory>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>

/// The part of Coal's interface that the adapter uses, in Coal's names (coal 3, include/coal/BVH/BVH_model.h),
/// forwarded to FCL. It shows that the adapter compiles and turns requests and results around as it should, not how
/// Coal answers.

namespace coal {

using Vec3s = Eigen::Vector3d;
using Matrix3s = Eigen::Matrix3d;
using OBBRSS = fcl::OBBRSSd;
template <class BV>
using BVNode = fcl::BVNode<BV>;
using fcl::BVH_OK;

/// Coal's triangle: three indices.
struct Triangle32 {
  using IndexType = std::uint32_t;
  Triangle32(IndexType first, IndexType second, IndexType third) : corners{first, second, third} {}
  IndexType corners[3];
};

class Transform3s {
 public:
  Transform3s() = default;
  Transform3s(const Matrix3s& R, const Vec3s& t) {
    X_.linear() = R;
    X_.translation() = t;
  }
  const fcl::Transform3d& fcl() const { return X_; }

 private:
  fcl::Transform3d X_ = fcl::Transform3d::Identity();
};

class CollisionGeometry {
 public:
  virtual ~CollisionGeometry() = default;
  fcl::BVHModel<fcl::OBBRSSd> model;
};

template <class BV>
class BVHModel : public CollisionGeometry {
 public:
  std::shared_ptr<std::vector<Triangle32>> tri_indices;
  unsigned num_tris = 0;

  int beginModel(unsigned triangles, unsigned vertices) {
    return model.beginModel(static_cast<int>(triangles), static_cast<int>(vertices));
  }
  int addSubModel(const std::vector<Vec3s>& vertices, const std::vector<Triangle32>& triangles) {
    std::vector<fcl::Triangle> converted;
    for (const Triangle32& t : triangles) converted.emplace_back(t.corners[0], t.corners[1], t.corners[2]);
    num_tris = static_cast<unsigned>(triangles.size());
    return model.addSubModel(vertices, converted);
  }
  int endModel() { return model.endModel(); }
  unsigned getNumBVs() const { return static_cast<unsigned>(model.getNumBVs()); }
};

}  // namespace coal
