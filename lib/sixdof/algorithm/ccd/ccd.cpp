#include <sixdof/algorithm/ccd/ccd.h>

#include <ccd/ccd.h>

#include <limits>
#include <type_traits>

#include <sixdof/oracle/convex_hull.h>

namespace sixdof {
namespace {

constexpr const char* k_method = "method";
constexpr const char* k_max_iterations = "max_iterations";

/// A hull at a pose in A's frame.
struct Hull {
  explicit Hull(const Mesh& mesh) : hull(convex_hull(mesh)) {}
  const Mesh hull;
  Pose X_A;
};

const Hull& hull_of(const void* object) { return *static_cast<const Hull*>(object); }

void write(const Eigen::Vector3d& v, ccd_vec3_t* out) { ccdVec3Set(out, v.x(), v.y(), v.z()); }

Eigen::Vector3d to_eigen(const ccd_vec3_t& v) { return {v.v[0], v.v[1], v.v[2]}; }

/// The vertex that is farthest along the direction.
void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  const Hull& body = hull_of(object);
  const Eigen::Vector3d along =
      body.X_A.R.transpose() * Eigen::Vector3d(direction->v[0], direction->v[1], direction->v[2]);
  double farthest = -std::numeric_limits<double>::infinity();
  const Eigen::Vector3d* best = nullptr;
  for (const Eigen::Vector3d& v : body.hull.vertices()) {
    const double height = v.dot(along);
    if (!(height > farthest)) continue;
    farthest = height;
    best = &v;
  }
  // None where the direction is not finite.
  write(body.X_A * (best != nullptr ? *best : body.hull.vertices().front()), out);
}

void center(const void* object, ccd_vec3_t* out) {
  const Hull& body = hull_of(object);
  write(body.X_A * body.hull.centroid(), out);
}

class CcdQuery final : public Query {
 public:
  CcdQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : a_(a), b_(b), is_mpr_(settings.choice(k_method) == "mpr") {
    CCD_INIT(&ccd_);
    ccd_.support1 = ccd_.support2 = &support;
    ccd_.center1 = ccd_.center2 = &center;
    ccd_.max_iterations = static_cast<unsigned long>(settings.number(k_max_iterations));
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    b_.X_A = X_AB;
    return (is_mpr_ ? ccdMPRIntersect(&a_, &b_, &ccd_) : ccdGJKIntersect(&a_, &b_, &ccd_)) != 0;
  }

  /// By EPA, or by MPR: one contact.
  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    b_.X_A = X_AB;
    ccd_real_t depth = 0.0;
    ccd_vec3_t direction, place;
    const int status = is_mpr_ ? ccdMPRPenetration(&a_, &b_, &ccd_, &depth, &direction, &place)
                               : ccdGJKPenetration(&a_, &b_, &ccd_, &depth, &direction, &place);
    if (status < -1) return fail(Status::failed, "EPA ran out of memory");
    if (status != 0 || most == 0) return Contacts{};
    return Contacts{{{.point = to_eigen(place), .normal = to_eigen(direction), .depth = depth}}};
  }

  Footprint footprint() const override {
    const auto vertices = a_.hull.vertices().size() + b_.hull.vertices().size();
    return {vertices * sizeof(Eigen::Vector3d), {{"vertices", static_cast<double>(vertices)}}};
  }

 private:
  static_assert(std::is_same_v<ccd_real_t, double>, "libccd is compiled for double precision");
  Hull a_, b_;
  const bool is_mpr_;
  ccd_t ccd_{};
};

}  // namespace

std::unique_ptr<Algorithm> make_ccd_hull_algorithm() {
  return make_algorithm<CcdQuery>(
      {.name = "ccd-hull",
       .version = SIXDOF_CCD_VERSION " double",
       .summary = "libccd on the convex hulls of both meshes; contacts by EPA, or by MPR",
       .answers = {.collide = true, .contacts = true},
       .depth = ContactDepth::bodies,
       .parameters = {Parameter::choice(k_method, "GJK, or Minkowski portal refinement", "gjk", {"gjk", "mpr"}),
                      Parameter::count(k_max_iterations, "after which the answer is no", "100", 1, 1e9)},
       .body = Body::convex_hull});
}

void register_ccd_algorithms(Registry& registry) { registry.add(make_ccd_hull_algorithm()); }

}  // namespace sixdof
