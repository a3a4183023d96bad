#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>

#include <sixdof/algorithm/library_query.h>
#include <sixdof/base/error.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/candidates.h>

/// Meshes as Embree takes them.

namespace sixdof {

/// Embree drops primitives with larger coordinates in silence (its FLT_LARGE, 1.844e18).
inline constexpr double k_largest_embree_coordinate = 1e18;

inline float embree_round_down(double x) {
  const auto f = static_cast<float>(x);
  return f <= x ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}
inline float embree_round_up(double x) { return -embree_round_down(-x); }

/// Whether the body is a point in Embree's floats, of which its builder asserts that there is none: the body is too
/// small, or too far away for its size.
inline bool is_point_in_floats(const Eigen::AlignedBox3d& box) {
  float largest = 0.0F;
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max(largest, embree_round_up(box.max()[axis]) - embree_round_down(box.min()[axis]));
  }
  return !(largest >= std::numeric_limits<float>::min());  // Embree takes smaller ones for zero
}

template <auto release>
struct ReleaseEmbree {
  template <class Handle>
  void operator()(Handle* handle) const {
    release(handle);
  }
};
using EmbreeDevice = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseEmbree<rtcReleaseDevice>>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseEmbree<rtcReleaseScene>>;
using EmbreeGeometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, ReleaseEmbree<rtcReleaseGeometry>>;

/// @throws std::runtime_error for the device's last error
inline void check_embree(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) throw std::runtime_error(fmt::format("Embree error {}", static_cast<int>(error)));
}

/// @throws BadMesh if Embree would drop triangles of the mesh where it is
inline void require_embree_range(const Mesh& mesh) {
  if (mesh.box().min().cwiseAbs().cwiseMax(mesh.box().max().cwiseAbs()).maxCoeff() >= k_largest_embree_coordinate) {
    throw BadMesh(mesh.name() + ": coordinates beyond Embree's largest");
  }
  if (is_point_in_floats(mesh.box())) {
    throw BadMesh(mesh.name() + ": coordinates that Embree's floats cannot tell apart");
  }
}

/// A mesh with its vertices in A's frame, as a scene.
class EmbreeMesh {
 public:
  EmbreeMesh(RTCDevice device, const Mesh& mesh, RTCSceneFlags flags, RTCBuildQuality scene_quality,
             RTCBuildQuality geometry_quality)
      : mesh_(mesh),
        vertices_A_(mesh.vertices()),
        scene_(rtcNewScene(device)),
        geometry_(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER)) {
    if (scene_ == nullptr || geometry_ == nullptr) check_embree(device);
    rtcSetSceneFlags(scene_.get(), flags);
    rtcSetSceneBuildQuality(scene_.get(), scene_quality);
    rtcSetGeometryBuildQuality(geometry_.get(), geometry_quality);
    rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(mesh.triangles().size()));
    rtcSetGeometryUserData(geometry_.get(), this);
    rtcSetGeometryBoundsFunction(geometry_.get(), &bounds, nullptr);
    rtcCommitGeometry(geometry_.get());
    rtcAttachGeometry(scene_.get(), geometry_.get());
    rtcCommitScene(scene_.get());
    check_embree(device);
  }
  EmbreeMesh(const EmbreeMesh&) = delete;
  EmbreeMesh& operator=(const EmbreeMesh&) = delete;

  /// @return why Embree cannot be asked there; null if it can
  const char* move(const Pose& X_AB) { return move(X_AB, mesh_.vertices()); }
  /// The same of a mesh that has deformed. @param vertices one for each of the mesh's, in its frame
  const char* move(const Pose& X_AB, std::span<const Eigen::Vector3d> vertices) {
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < vertices_A_.size(); ++i) {
      vertices_A_[i] = transform_point(X_AB, vertices[i]);
      box.extend(vertices_A_[i]);
    }
    // It would drop a triangle.
    if (!(box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff() < k_largest_embree_coordinate)) {
      return "coordinates beyond Embree's largest";
    }
    if (is_point_in_floats(box)) return "coordinates that Embree's floats cannot tell apart";
    rtcCommitGeometry(geometry_.get());
    rtcCommitScene(scene_.get());
    return nullptr;
  }

  TriangleCorners corners(unsigned triangle) const {
    const Triangle& t = mesh_.triangles()[triangle];
    return {vertices_A_[t[0]], vertices_A_[t[1]], vertices_A_[t[2]]};
  }

  RTCScene scene() const { return scene_.get(); }

 private:
  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto& body = *static_cast<const EmbreeMesh*>(arguments->geometryUserPtr);
    const TriangleCorners t = body.corners(arguments->primID);
    const Eigen::Vector3d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    RTCBounds& box = *arguments->bounds_o;
    box.lower_x = embree_round_down(low.x());
    box.lower_y = embree_round_down(low.y());
    box.lower_z = embree_round_down(low.z());
    box.upper_x = embree_round_up(high.x());
    box.upper_y = embree_round_up(high.y());
    box.upper_z = embree_round_up(high.z());
  }

  const Mesh& mesh_;
  std::vector<Eigen::Vector3d> vertices_A_;
  const EmbreeScene scene_;
  const EmbreeGeometry geometry_;
};

/// Whether two triangles have a point in common, by the exact test.
inline bool triangles_meet(const TriangleCorners& a, const TriangleCorners& b) {
  const auto low = [](const TriangleCorners& t) { return t[0].cwiseMin(t[1]).cwiseMin(t[2]).array(); };
  const auto high = [](const TriangleCorners& t) { return t[0].cwiseMax(t[1]).cwiseMax(t[2]).array(); };
  return (low(a) <= high(b)).all() && (low(b) <= high(a)).all() && triangles_intersect(a, b);
}

}  // namespace sixdof
