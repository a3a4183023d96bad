#include <sixdof/algorithm/vps/vps.h>

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include <sixdof/algorithm/vps/contact.h>
#include <sixdof/algorithm/vps/store.h>
#include <sixdof/base/error.h>

namespace sixdof {
namespace {

using namespace vps;

/// Past so many contacts the 1999 force no longer grows: McNeely et al. 1999, section 4.
constexpr double k_free_contacts = 10.0;

/// What the two algorithms have in common: points in a tree against something on a grid.
class PointQuery : public Query {
 public:
  PointQuery(const Mesh& voxelised, const Mesh& pointed, const Mesh& b, const Settings& settings)
      : map_(prepare_voxelmap(voxelised, settings)),
        tree_(prepare_pointshell(pointed, settings), pointed.center(), settings.choice("weight") == "area"),
        b_center_(b.center()),
        points_of_b_(settings.choice("pointshell") == "b"),
        by_area_(settings.choice("weight") == "area"),
        culling_(settings.choice("culling") == "on"),
        stiffness_(settings.number("stiffness")) {
    all_leaves_.resize(culling_ ? 0 : tree_.leaves());
    std::iota(all_leaves_.begin(), all_leaves_.end(), 0u);
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if (!finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    const Pose X = points_of_b_ ? X_AB : X_AB.inverse();
    const Placement placement = Placement::of(X, tree_.center(), map_.grid);
    visited_leaves_ = 0;
    const auto touched = [&](std::span<const std::uint32_t> leaves) {
      visited_leaves_ += leaves.size();
      return touches(placement, leaves);
    };
    return culling_ ? tree_.any_leaves(map_, placement, reach(), scratch_, touched) : touched(all_leaves_);
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (!finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    const Pose X = points_of_b_ ? X_AB : X_AB.inverse();
    const Placement placement = Placement::of(X, tree_.center(), map_.grid);
    const std::span<const std::uint32_t> leaves =
        culling_ ? tree_.cull(map_, placement, reach(), scratch_) : std::span<const std::uint32_t>(all_leaves_);
    visited_leaves_ = leaves.size();
    Response response;
    if (!leaves.empty()) response = wrench_on_points(X, placement, leaves);
    response.reference = X * tree_.center();
    if (!by_area_) {
      const double share = std::max(1.0, contacts_ / k_free_contacts);
      response.force /= share;
      response.torque /= share;
    }
    if (!points_of_b_) {
      // The wrench acted on A's points, in B's frame. On B acts the opposite one, about B's own centre.
      response.force = -response.force;
      response.torque = -response.torque;
      response = response.about(b_center_);
      response.force = X_AB.R * response.force;
      response.torque = X_AB.R * response.torque;
    }
    response.reference = X_AB * b_center_;
    return response;
  }

  Footprint footprint() const override {
    return {.bytes = map_.bytes() + tree_.bytes() + all_leaves_.capacity() * sizeof(all_leaves_[0]),
            .counts = {{"voxels", map_.grid.voxel_count()},
                       {"surface_voxels", static_cast<double>(map_.surface_voxels)},
                       {"inside_voxels", static_cast<double>(map_.inside_voxels)},
                       {"bricks", static_cast<double>(map_.stored_bricks())},
                       {"points", static_cast<double>(tree_.points())},
                       {"nodes", static_cast<double>(tree_.nodes())}}};
  }

  /// Whole leaves are visited.
  std::vector<Work> work() const override {
    const auto points = static_cast<double>(tree_.points());
    return {{"points", std::min(points, static_cast<double>(visited_leaves_ * PointTree::k_leaf_points)), points}};
  }

 protected:
  virtual double reach() const = 0;
  virtual bool touches(const Placement& placement, std::span<const std::uint32_t> leaves) const = 0;
  /// Wrench on the points, in the voxels' frame; also sets contacts_.
  virtual Response wrench_on_points(const Pose& X, const Placement& placement,
                                    std::span<const std::uint32_t> leaves) = 0;

  VoxelMap map_;
  PointTree tree_;
  double contacts_ = 0.0;
  double stiffness() const { return stiffness_; }

 private:
  static bool finite(const Pose& X) { return X.R.allFinite() && X.t.allFinite(); }

  Eigen::Vector3d b_center_;
  bool points_of_b_;
  bool by_area_;
  bool culling_;
  double stiffness_;
  std::vector<std::uint32_t> all_leaves_;  ///< Without culling.
  PointTree::Scratch scratch_;
  std::size_t visited_leaves_ = 0;  ///< By the last query.
};

class LayerQuery final : public PointQuery {
 public:
  LayerQuery(const Mesh& voxelised, const Mesh& pointed, const Mesh& b, const Settings& settings)
      : PointQuery(voxelised, pointed, b, settings),
        depth_(settings.choice("depth") == "layers" ? LayerDepth::layers : LayerDepth::layers_and_local) {}

 private:
  double reach() const override { return 0.0; }
  bool touches(const Placement& placement, std::span<const std::uint32_t> leaves) const override {
    return touches_layers(map_, tree_, placement, leaves);
  }
  Response wrench_on_points(const Pose& X, const Placement& placement, std::span<const std::uint32_t> leaves) override {
    const ContactSums sums = sum_layers(map_, tree_, placement, depth_, leaves);
    contacts_ = sums.contacts;
    const double size = map_.grid.size;
    return {.penalty = size * sums.depth,
            .force = stiffness() * size * (X.R * sums.force),
            .torque = stiffness() * size * (X.R * sums.torque)};
  }

  LayerDepth depth_;
};

class FieldQuery final : public PointQuery {
 public:
  FieldQuery(const Mesh& voxelised, const Mesh& pointed, const Mesh& b, const Settings& settings)
      : PointQuery(voxelised, pointed, b, settings), field_(cached_field(voxelised, map_)) {}

  Footprint footprint() const override {
    Footprint footprint = PointQuery::footprint();
    footprint.bytes += field_.bytes();
    footprint.counts.emplace_back("field_bricks", static_cast<double>(field_.stored_bricks()));
    return footprint;
  }

 private:
  double reach() const override { return DistanceField::k_reach; }
  bool touches(const Placement& placement, std::span<const std::uint32_t> leaves) const override {
    return touches_field(field_, tree_, placement, leaves);
  }
  Response wrench_on_points(const Pose&, const Placement& placement, std::span<const std::uint32_t> leaves) override {
    const ContactSums sums = sum_field(field_, tree_, placement, leaves);
    contacts_ = sums.contacts;
    // The energy is k sum w (s f)^2 / 2, its argument a position in voxels: one s for f, and one more for the arm.
    const double size = map_.grid.size;
    return {.penalty = size * sums.depth,
            .force = stiffness() * size * sums.force,
            .torque = stiffness() * size * size * sums.torque};
  }

  DistanceField field_;
};

std::vector<Parameter> common_parameters(const std::string& voxel_size, const std::string& point_spacing, int least_border) {
  return {
      {.name = "voxel_size",
       .meaning = "Edge of a voxel, as a fraction of the diagonal of the voxelised body's box.",
       .unit = "diagonal",
       .standard = voxel_size,
       .low = 0.0005,
       .high = 0.1},
      {.name = "point_spacing",
       .meaning = "Distance of neighbouring points, as a fraction of the diagonal of their body's box.",
       .unit = "diagonal",
       .standard = point_spacing,
       .low = 0.0005,
       .high = 0.1},
      {.name = "border",
       .meaning = "Voxel layers outside the body that are stored; further out one distance per brick serves culling.",
       .unit = "voxels",
       .standard = "4",
       .low = static_cast<double>(least_border),
       .high = 64,
       .integer = true},
      {.name = "weight",
       .meaning = "What a point weighs: the area it stands for, or 1 with the sum over a tenth of the contacts (1999).",
       .unit = "1",
       .standard = "area",
       .choices = {"area", "contacts"}},
      {.name = "pointshell",
       .meaning = "The body that carries the points; the other one is voxelised.",
       .unit = "1",
       .standard = "b",
       .choices = {"b", "a"}},
      {.name = "stiffness",
       .meaning = "Factor k of force and torque.",
       .unit = "force/length^3",
       .standard = "1",
       .low = 1e-12,
       .high = 1e12},
      {.name = "culling",
       .meaning = "Whether the point tree leaves out points that are surely apart; changes no bit of an answer.",
       .unit = "1",
       .standard = "on",
       .choices = {"on", "off"}},
  };
}

void require_solid(const Mesh& mesh, const char* algorithm) {
  if (!mesh.solid()) {
    throw BadMesh(fmt::format("{}: {} needs a solid: {}", mesh.name(), algorithm, mesh.why_not_solid()));
  }
}

template <class QueryType>
std::unique_ptr<Query> make_query(const Mesh& a, const Mesh& b, const Settings& settings, const char* algorithm) {
  require_solid(a, algorithm);
  require_solid(b, algorithm);
  const bool points_of_b = settings.choice("pointshell") == "b";
  return std::make_unique<QueryType>(points_of_b ? a : b, points_of_b ? b : a, b, settings);
}

class VpsAlgorithm final : public Algorithm {
 public:
  VpsAlgorithm() {
    traits_.parameters.insert(traits_.parameters.begin() + 2,
                         {.name = "depth",
                          .meaning = "How penetration is read: layer of the voxel, with or without the place in it.",
                          .unit = "1",
                          .standard = "layers+local",
                          .choices = {"layers", "layers+local"}});
  }
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
    return make_query<LayerQuery>(a, b, settings, "vps");
  }

 private:
  Traits traits_{.name = "vps",
                 .version = SIXDOF_VERSION,
                 .summary = "voxmap-pointshell: integer layers of A at points of B (McNeely 1999, Sagardia 2008)",
                 .answers = {.collide = true, .distance = false, .respond = true},
                 .law = ResponseLaw::depth,
                 .parameters = common_parameters("0.004", "0.004", 0)};
};

class VpsFieldAlgorithm final : public Algorithm {
 public:
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
    return make_query<FieldQuery>(a, b, settings, "vps-field");
  }

 private:
  Traits traits_{.name = "vps-field",
                 .version = SIXDOF_VERSION,
                 .summary = "points of B in a smooth signed distance to A: conservative, continuous voxmap-pointshell",
                 .answers = {.collide = true, .distance = false, .respond = true},
                 .law = ResponseLaw::depth,
                 .parameters = common_parameters("0.008", "0.004", DistanceField::k_border)};
};

}  // namespace

namespace vps {

VoxelMap prepare_voxelmap(const Mesh& mesh, const Settings& settings) {
  return cached_voxelmap(mesh, settings.number("voxel_size") * mesh.diagonal(),
                         static_cast<int>(settings.number("border")));
}

PointShell prepare_pointshell(const Mesh& mesh, const Settings& settings) {
  return cached_pointshell(mesh, settings.number("point_spacing") * mesh.diagonal());
}

}  // namespace vps

std::unique_ptr<Algorithm> make_vps_algorithm() { return std::make_unique<VpsAlgorithm>(); }
std::unique_ptr<Algorithm> make_vps_field_algorithm() { return std::make_unique<VpsFieldAlgorithm>(); }

}  // namespace sixdof
