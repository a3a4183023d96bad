#include <sixdof/algorithm/vps/vps.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/algorithm/require_solid.h>
#include <sixdof/algorithm/vps/cached_structures.h>
#include <sixdof/algorithm/vps/contact.h>

namespace sixdof {
namespace {

using namespace vps;

/// With more contacts than this the force of 1999 is a mean: McNeely et al. 1999, section 4.
constexpr double k_summed_contacts = 10.0;

/// The bodies of a pair by their roles. @throws BadMesh if one of them is not solid
struct Roles {
  Roles(const Mesh& a, const Mesh& b, const Settings& settings)
      : points_on_b(settings.choice("pointshell") == "b"), voxels(points_on_b ? a : b), points(points_on_b ? b : a) {
    require_solid(a, "voxmap-pointshell");
    require_solid(b, "voxmap-pointshell");
  }
  bool points_on_b;
  const Mesh& voxels;  ///< Is voxelised.
  const Mesh& points;  ///< Has the points.
};

/// Common to both algorithms: a tree of points against a structure on a voxel grid.
class PointQuery : public Query {
 public:
  PointQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : roles_(a, b, settings),
        map_(prepare_voxelmap(roles_.voxels, settings)),
        tree_(prepare_pointshell(roles_.points, settings), roles_.points.center(), settings.choice("weight") == "area"),
        b_center_(b.center()),
        by_area_(settings.choice("weight") == "area"),
        culling_(settings.choice("culling") == "on"),
        stiffness_(settings.number("stiffness")) {
    all_leaves_.resize(culling_ ? 0 : tree_.leaves());
    std::iota(all_leaves_.begin(), all_leaves_.end(), 0u);
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    const Pose X = roles_.points_on_b ? X_AB : X_AB.inverse();
    const VoxelTransform transform = VoxelTransform::of(X, tree_.center(), map_.grid);
    tested_leaves_ = 0;
    const auto test = [&](std::span<const std::uint32_t> leaves) {
      tested_leaves_ += leaves.size();
      return touches(transform, leaves);
    };
    return culling_ ? tree_.any_leaves(map_, transform, reach(), scratch_, test) : test(all_leaves_);
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    const Pose X = roles_.points_on_b ? X_AB : X_AB.inverse();
    const VoxelTransform transform = VoxelTransform::of(X, tree_.center(), map_.grid);
    const std::span<const std::uint32_t> leaves =
        culling_ ? tree_.cull(map_, transform, reach(), scratch_) : std::span<const std::uint32_t>(all_leaves_);
    tested_leaves_ = leaves.size();
    Response response;
    if (!leaves.empty()) response = wrench_on_points(X, transform, leaves);
    response.reference = X * tree_.center();
    if (!by_area_) {
      const double divisor = std::max(1.0, contacts_ / k_summed_contacts);
      response.force /= divisor;
      response.torque /= divisor;
    }
    if (!roles_.points_on_b) {
      // The wrench acts on A's points, in B's frame. The opposite one acts on B, about B's centre.
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

  /// All points of a leaf are tested.
  std::vector<Work> work() const override {
    const auto points = static_cast<double>(tree_.points());
    return {{"points", std::min(points, static_cast<double>(tested_leaves_ * PointTree::k_leaf_points)), points}};
  }

 protected:
  virtual double reach() const = 0;
  virtual bool touches(const VoxelTransform& transform, std::span<const std::uint32_t> leaves) const = 0;
  /// Wrench on the points, in the voxels' frame; also sets contacts_.
  virtual Response wrench_on_points(const Pose& X, const VoxelTransform& transform,
                                    std::span<const std::uint32_t> leaves) = 0;

  const Roles roles_;
  VoxelMap map_;
  PointTree tree_;
  double contacts_ = 0.0;
  double stiffness() const { return stiffness_; }

 private:
  Eigen::Vector3d b_center_;
  bool by_area_;
  bool culling_;
  double stiffness_;
  std::vector<std::uint32_t> all_leaves_;  ///< Without culling.
  PointTree::Scratch scratch_;
  std::size_t tested_leaves_ = 0;  ///< By the last query.
};

class LayerQuery final : public PointQuery {
 public:
  LayerQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : PointQuery(a, b, settings),
        depth_(settings.choice("depth") == "layers" ? LayerDepth::layers : LayerDepth::layers_and_local) {}

 private:
  double reach() const override { return 0.0; }
  bool touches(const VoxelTransform& transform, std::span<const std::uint32_t> leaves) const override {
    return touches_layers(map_, tree_, transform, leaves);
  }
  Response wrench_on_points(const Pose& X, const VoxelTransform& transform,
                            std::span<const std::uint32_t> leaves) override {
    const ContactSums sums = sum_layers(map_, tree_, transform, depth_, leaves);
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
  FieldQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : PointQuery(a, b, settings), field_(cached_field(roles_.voxels, map_)) {}

  Footprint footprint() const override {
    Footprint footprint = PointQuery::footprint();
    footprint.bytes += field_.bytes();
    footprint.counts.emplace_back("field_bricks", static_cast<double>(field_.stored_bricks()));
    return footprint;
  }

 private:
  double reach() const override { return DistanceField::k_reach; }
  bool touches(const VoxelTransform& transform, std::span<const std::uint32_t> leaves) const override {
    return touches_field(field_, tree_, transform, leaves);
  }
  Response wrench_on_points(const Pose&, const VoxelTransform& transform,
                            std::span<const std::uint32_t> leaves) override {
    const ContactSums sums = sum_field(field_, tree_, transform, leaves);
    contacts_ = sums.contacts;
    // The energy is k sum w (s f)^2 / 2 with f and positions in voxels: a factor s for f, and another for the arm.
    const double size = map_.grid.size;
    return {.penalty = size * sums.depth,
            .force = stiffness() * size * sums.force,
            .torque = stiffness() * size * size * sums.torque};
  }

  DistanceField field_;
};

std::vector<Parameter> common_parameters(const std::string& voxel_size, const std::string& point_spacing,
                                         int min_border) {
  return {
      {.name = "voxel_size",
       .meaning = "edge of a voxel, as a fraction of the diagonal of the voxelised body's box",
       .unit = "diagonal",
       .default_value = voxel_size,
       .low = 0.0005,
       .high = 0.1},
      {.name = "point_spacing",
       .meaning = "distance of neighbouring points, as a fraction of the diagonal of their body's box",
       .unit = "diagonal",
       .default_value = point_spacing,
       .low = 0.0005,
       .high = 0.1},
      {.name = "border",
       .meaning = "voxel layers outside the body that are stored; beyond them culling uses one distance per brick",
       .unit = "voxels",
       .default_value = "4",
       .low = static_cast<double>(min_border),
       .high = 64,
       .integer = true},
      {.name = "weight",
       .meaning = "area: a point's weight is the area of its cell; contacts: it is 1, and the sum over more than ten "
                  "contacts is divided by a tenth of their number (1999)",
       .unit = "",
       .default_value = "area",
       .choices = {"area", "contacts"}},
      {.name = "pointshell",
       .meaning = "the body that has the points; the other one is voxelised",
       .unit = "",
       .default_value = "b",
       .choices = {"b", "a"}},
      {.name = "stiffness",
       .meaning = "factor k of force and torque",
       .unit = "force/length^3",
       .default_value = "1",
       .low = 1e-12,
       .high = 1e12},
      {.name = "culling",
       .meaning = "whether the point tree leaves out points without contact; changes no bit of an answer",
       .unit = "",
       .default_value = "on",
       .choices = {"on", "off"}},
  };
}

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

std::unique_ptr<Algorithm> make_vps_algorithm() {
  std::vector<Parameter> parameters = common_parameters("0.004", "0.004", 0);
  parameters.insert(
      parameters.begin() + 2,
      {.name = "depth",
       .meaning = "penetration of a point: the layer of its voxel, with or without its position in the voxel",
       .unit = "",
       .default_value = "layers+local",
       .choices = {"layers", "layers+local"}});
  return make_algorithm<LayerQuery>(
      {.name = "vps",
       .version = SIXDOF_VERSION,
       .summary = "voxmap-pointshell: integer layers of A at points of B (McNeely 1999, Sagardia 2008)",
       .answers = {.collide = true, .respond = true},
       .law = ResponseLaw::depth,
       .parameters = std::move(parameters)});
}

std::unique_ptr<Algorithm> make_vps_field_algorithm() {
  return make_algorithm<FieldQuery>(
      {.name = "vps-field",
       .version = SIXDOF_VERSION,
       .summary = "points of B in a smooth signed distance to A: conservative, continuous voxmap-pointshell",
       .answers = {.collide = true, .respond = true},
       .law = ResponseLaw::depth,
       .parameters = common_parameters("0.008", "0.004", DistanceField::k_border)});
}

}  // namespace sixdof
