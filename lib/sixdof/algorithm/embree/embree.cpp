#include <sixdof/algorithm/embree/embree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <vector>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <sixdof/algorithm/library_query.h>
#include <sixdof/geometry/triangle_distance.h>
#include <sixdof/oracle/candidates.h>

namespace sixdof {
namespace {

constexpr const char* k_profile = "profile";
/// Embree drops primitives with larger coordinates in silence (its FLT_LARGE, 1.844e18).
constexpr double k_largest_coordinate = 1e18;

float round_down(double x) {
  const auto f = static_cast<float>(x);
  return f <= x ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}
float round_up(double x) { return -round_down(-x); }

/// Whether the body is a point in Embree's floats, of which its builder asserts that there is none: the body is too
/// small, or too far away for its size.
bool is_point_in_floats(const Eigen::AlignedBox3d& box) {
  float largest = 0.0F;
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max(largest, round_up(box.max()[axis]) - round_down(box.min()[axis]));
  }
  return !(largest >= std::numeric_limits<float>::min());  // Embree takes smaller ones for zero
}

template <auto release>
struct Release {
  template <class Handle>
  void operator()(Handle* handle) const {
    release(handle);
  }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release<rtcReleaseDevice>>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release<rtcReleaseScene>>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Release<rtcReleaseGeometry>>;

/// @throws std::runtime_error for the device's last error
void check(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) throw std::runtime_error(fmt::format("Embree error {}", static_cast<int>(error)));
}

/// A mesh with its vertices in A's frame, as a scene.
class Body {
 public:
  Body(RTCDevice device, const Mesh& mesh, RTCSceneFlags flags, RTCBuildQuality scene_quality,
       RTCBuildQuality geometry_quality)
      : mesh_(mesh),
        vertices_A_(mesh.vertices()),
        scene_(rtcNewScene(device)),
        geometry_(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER)) {
    if (scene_ == nullptr || geometry_ == nullptr) check(device);
    rtcSetSceneFlags(scene_.get(), flags);
    rtcSetSceneBuildQuality(scene_.get(), scene_quality);
    rtcSetGeometryBuildQuality(geometry_.get(), geometry_quality);
    rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(mesh.triangles().size()));
    rtcSetGeometryUserData(geometry_.get(), this);
    rtcSetGeometryBoundsFunction(geometry_.get(), &bounds, nullptr);
    rtcCommitGeometry(geometry_.get());
    rtcAttachGeometry(scene_.get(), geometry_.get());
    rtcCommitScene(scene_.get());
    check(device);
  }
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  /// @return why Embree cannot be asked there; null if it can
  const char* move(const Pose& X_AB) {
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < vertices_A_.size(); ++i) {
      vertices_A_[i] = transform_point(X_AB, mesh_.vertices()[i]);
      box.extend(vertices_A_[i]);
    }
    // It would drop a triangle.
    if (!(box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff() < k_largest_coordinate)) {
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
    const auto& body = *static_cast<const Body*>(arguments->geometryUserPtr);
    const TriangleCorners t = body.corners(arguments->primID);
    const Eigen::Vector3d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    RTCBounds& box = *arguments->bounds_o;
    box.lower_x = round_down(low.x());
    box.lower_y = round_down(low.y());
    box.lower_z = round_down(low.z());
    box.upper_x = round_up(high.x());
    box.upper_y = round_up(high.y());
    box.upper_z = round_up(high.z());
  }

  const Mesh& mesh_;
  std::vector<Eigen::Vector3d> vertices_A_;
  const Scene scene_;
  const Geometry geometry_;
};

bool boxes_overlap(const TriangleCorners& a, const TriangleCorners& b) {
  const auto low = [](const TriangleCorners& t) { return t[0].cwiseMin(t[1]).cwiseMin(t[2]).array(); };
  const auto high = [](const TriangleCorners& t) { return t[0].cwiseMax(t[1]).cwiseMax(t[2]).array(); };
  return (low(a) <= high(b)).all() && (low(b) <= high(a)).all();
}

class EmbreeQuery final : public LibraryQuery {
 public:
  EmbreeQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : triangles_(a.triangles().size() + b.triangles().size()), device_(rtcNewDevice("threads=1")) {
    check(nullptr);
    for (const Mesh* mesh : {&a, &b}) {
      if (mesh->box().min().cwiseAbs().cwiseMax(mesh->box().max().cwiseAbs()).maxCoeff() >= k_largest_coordinate) {
        throw BadMesh(mesh->name() + ": coordinates beyond Embree's largest");
      }
      if (is_point_in_floats(mesh->box())) {
        throw BadMesh(mesh->name() + ": coordinates that Embree's floats cannot tell apart");
      }
    }
    const bool tuned = settings.choice(k_profile) == "tuned";
    one_thread_.execute([&] {
      a_ = std::make_unique<Body>(device_.get(), a, RTC_SCENE_FLAG_NONE,
                                  tuned ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_MEDIUM);
      b_ = std::make_unique<Body>(device_.get(), b, tuned ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE,
                                  RTC_BUILD_QUALITY_LOW, tuned ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
    });
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    return guarded(X_AB, [&]() -> Outcome<bool> {
      found_ = false;
      const char* const why_not = one_thread_.execute([&] {
        const char* const why = b_->move(X_AB);
        if (why == nullptr) rtcCollide(a_->scene(), b_->scene(), &receive, this);
        return why;
      });
      if (why_not != nullptr) return fail(Status::failed, why_not);
      check(device_.get());
      return found_;
    });
  }

  /// Embree does not tell the size of its trees.
  Footprint footprint() const override { return {0, {{"triangles", static_cast<double>(triangles_)}}}; }

 private:
  static void receive(void* self, RTCCollision* pairs, unsigned count) {
    auto& query = *static_cast<EmbreeQuery*>(self);
    for (unsigned i = 0; i < count && !query.found_; ++i) {
      const TriangleCorners a = query.a_->corners(pairs[i].primID0), b = query.b_->corners(pairs[i].primID1);
      query.found_ = boxes_overlap(a, b) && triangles_intersect(a, b);
    }
  }

  const std::size_t triangles_;
  tbb::task_arena one_thread_{1};
  const Device device_;
  std::unique_ptr<Body> a_, b_;
  bool found_ = false;
};

}  // namespace

std::unique_ptr<Algorithm> make_embree_algorithm() {
  return make_algorithm<EmbreeQuery>(
      {.name = "embree",
       .version = RTC_VERSION_STRING " float",
       .summary = "Embree's rtcCollide with this project's exact test of triangles; every query moves and refits B",
       .answers = {.collide = true},
       .limits = {.surfaces_only = {.collide = true}},
       .parameters = {Parameter::choice(k_profile, "default: Embree's tutorial; tuned: its manual's advice", "default",
                                        {"default", "tuned"})}});
}

void register_embree_algorithms(Registry& registry) { registry.add(make_embree_algorithm()); }

}  // namespace sixdof
