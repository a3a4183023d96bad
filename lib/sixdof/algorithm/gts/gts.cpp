#include <sixdof/algorithm/gts/gts.h>

#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gts.h>

#include <sixdof/algorithm/volume_response.h>
#include <sixdof/base/error.h>
#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/solid.h>

namespace sixdof {
namespace {

void ignore(const gchar* /*domain*/, GLogLevelFlags /*level*/, const gchar* /*message*/, gpointer /*data*/) {}

/// GTS's classes, and its marks on objects, belong to the process.
class GtsLock {
 public:
  GtsLock() : lock_(mutex()) {
    static const guint handler = g_log_set_handler("Gts", G_LOG_LEVEL_MASK, &ignore, nullptr);
    static_cast<void>(handler);
  }

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
};

struct DestroyObject {
  template <class Object>
  void operator()(Object* object) const {
    gts_object_destroy(GTS_OBJECT(object));
  }
};
struct DestroyTree {
  void operator()(GNode* tree) const { gts_bb_tree_destroy(tree, TRUE); }
};
using Surface = std::unique_ptr<GtsSurface, DestroyObject>;
using Inter = std::unique_ptr<GtsSurfaceInter, DestroyObject>;
using BoxTree = std::unique_ptr<GNode, DestroyTree>;

Surface new_surface() {
  return Surface(gts_surface_new(gts_surface_class(), gts_face_class(), gts_edge_class(), gts_vertex_class()));
}

/// A mesh as GTS has it. Made, used and destroyed under a GtsLock.
class Body {
 public:
  explicit Body(const Mesh& mesh) : mesh_(mesh), surface_(new_surface()) {
    for (const Eigen::Vector3d& v : mesh.vertices()) {
      vertices_.push_back(gts_vertex_new(gts_vertex_class(), v.x(), v.y(), v.z()));
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, GtsEdge*> edges;
    for (const Triangle& t : mesh.triangles()) {
      GtsEdge* sides[3];
      for (int i = 0; i < 3; ++i) {
        const auto [from, to] = std::minmax(t[i], t[(i + 1) % 3]);
        GtsEdge*& edge = edges[{from, to}];
        if (edge == nullptr) edge = gts_edge_new(gts_edge_class(), vertices_[from], vertices_[to]);
        sides[i] = edge;
      }
      gts_surface_add_face(surface_.get(), gts_face_new(gts_face_class(), sides[0], sides[1], sides[2]));
    }
    tree_.reset(gts_bb_tree_surface(surface_.get()));
  }

  void move(const Pose& X_AB) {
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const Eigen::Vector3d p = transform_point(X_AB, mesh_.vertices()[i]);
      gts_point_set(GTS_POINT(vertices_[i]), p.x(), p.y(), p.z());
    }
    tree_.reset(gts_bb_tree_surface(surface_.get()));
  }

  GtsSurface* surface() const { return surface_.get(); }
  GNode* tree() const { return tree_.get(); }
  const Mesh& mesh() const { return mesh_; }

  bool holds_first_vertex_of(const Body& other) const {
    return gts_point_is_inside_surface(GTS_POINT(other.vertices_[0]), tree_.get(), FALSE);
  }

 private:
  const Mesh& mesh_;
  const Surface surface_;
  std::vector<GtsVertex*> vertices_;
  BoxTree tree_;
};

Eigen::Vector3d position(const GtsVertex* vertex) {
  const GtsPoint* p = &vertex->p;
  return {p->x, p->y, p->z};
}

struct Sum {
  VolumeResponse* response;
  bool of_b;
};

/// A GtsFunc. @param sum a Sum
gint add_face(gpointer face, gpointer sum) {
  GtsVertex *p, *q, *r;
  gts_triangle_vertices(GTS_TRIANGLE(face), &p, &q, &r);
  const auto& [response, of_b] = *static_cast<const Sum*>(sum);
  response->add(position(p), position(q), position(r), of_b);
  return 0;
}

class GtsQuery final : public Query {
 public:
  GtsQuery(const Mesh& a, const Mesh& b, const Settings& /*settings*/) : center_b_(b.center()) {
    for (const Mesh* mesh : {&a, &b}) {
      if (!mesh->solid()) throw BadMesh(mesh->name() + ": gts needs a solid: " + mesh->why_not_solid() + k_repair_hint);
    }
    const GtsLock lock;
    a_ = std::make_unique<Body>(a);
    b_ = std::make_unique<Body>(b);
  }
  GtsQuery(const GtsQuery&) = delete;
  GtsQuery& operator=(const GtsQuery&) = delete;
  ~GtsQuery() override {
    const GtsLock lock;
    a_.reset();
    b_.reset();
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    const GtsLock lock;
    const Inter curves = intersect(X_AB);
    return curves->edges != nullptr || a_->holds_first_vertex_of(*b_) || b_->holds_first_vertex_of(*a_);
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    const GtsLock lock;
    const Inter curves = intersect(X_AB);
    if (curves->edges == nullptr) return response_of_whole_bodies(X_AB);
    gboolean closed = TRUE;
    if (!gts_surface_inter_check(curves.get(), &closed) || !closed) {
      return fail(Status::failed, "the curves are not closed");
    }
    VolumeResponse response(X_AB * center_b_);
    for (const auto& [part, of_b] : {std::pair(GTS_1_IN_2, false), {GTS_2_IN_1, true}}) {
      const Surface inside = new_surface();
      gts_surface_inter_boolean(curves.get(), inside.get(), part);
      Sum sum{&response, of_b};
      gts_surface_foreach_face(inside.get(), &add_face, &sum);
    }
    return response.response();
  }

  Footprint footprint() const override {
    const double triangles = static_cast<double>(a_->mesh().triangles().size() + b_->mesh().triangles().size());
    return {0, {{"triangles", triangles}}};
  }

 private:
  Inter intersect(const Pose& X_AB) {
    b_->move(X_AB);
    return Inter(gts_surface_inter_new(gts_surface_inter_class(), a_->surface(), b_->surface(), a_->tree(), b_->tree(),
                                       FALSE, FALSE));
  }

  /// Of bodies whose surfaces do not cross.
  Response response_of_whole_bodies(const Pose& X_AB) const {
    Response response{.volume = 0.0, .reference = X_AB * center_b_};
    if (a_->holds_first_vertex_of(*b_)) {
      response.volume = b_->mesh().volume();
    } else if (b_->holds_first_vertex_of(*a_)) {
      response.volume = a_->mesh().volume();
    }
    response.penalty = response.volume;
    return response;
  }

  const Eigen::Vector3d center_b_;
  std::unique_ptr<Body> a_, b_;
};

}  // namespace

std::unique_ptr<Algorithm> make_gts_algorithm() {
  return make_algorithm<GtsQuery>({.name = "gts",
                                   .version = SIXDOF_GTS_VERSION,
                                   .summary = "GTS: volume of the intersection by Boolean operations, and its gradient",
                                   .answers = {.collide = true, .respond = true},
                                   .law = ResponseLaw::volume,
                                   .by_default = false});
}

void register_gts_algorithms(Registry& registry) { registry.add(make_gts_algorithm()); }

}  // namespace sixdof
