#include <sixdof/algorithm/vps/vps.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <sixdof/algorithm/preparation.h>
#include <sixdof/algorithm/vps/contact.h>

namespace sixdof {
namespace vps {
namespace {

/// Whether a table has an entry for every brick of the grid, from `lowest` on, and every entry refers to a stored brick
/// or is negative. Queries rely on it: they do not check indices.
bool fits(const std::vector<std::int32_t>& table, const VoxelGrid& grid, std::uint64_t stored, std::int32_t lowest) {
  return table.size() == static_cast<std::size_t>(grid.bricks.cast<std::int64_t>().prod()) &&
         std::all_of(table.begin(), table.end(), [&](std::int32_t entry) {
           return entry >= lowest && (entry < 0 || static_cast<std::uint64_t>(entry) < stored);
         });
}

}  // namespace

// The versions in the keys are to be increased whenever the same mesh and settings give another structure or layout.

VoxelMap prepare_voxelmap(const Mesh& mesh, const Settings& settings) {
  const double voxel_size = settings.number("voxel_size") * mesh.diagonal();
  const auto border = static_cast<int>(settings.number("border"));
  const std::string key =
      fmt::format("version 2, mesh {}, voxel size {:a}, border {}", mesh.hash(), voxel_size, border);
  const auto visit = [](CacheMembers members, VoxelMap& map) {
    VoxelGrid& grid = map.grid;
    members.numbers<double>("grid", grid.origin.x(), grid.origin.y(), grid.origin.z(), grid.size);
    members.numbers<std::int32_t>("shape", grid.bricks.x(), grid.bricks.y(), grid.bricks.z(), map.border,
                                  map.layer_bits);
    members.numbers<std::uint64_t>("counts", map.surface_voxels, map.inside_voxels);
    members.array("table", map.table);
    members.array("words", map.words);
  };
  const VoxelGrid expected = VoxelGrid::around(mesh.box(), voxel_size, VoxelMap::k_margin);
  const auto valid = [&](const VoxelMap& map) {
    return map.grid == expected && map.border == border && (map.layer_bits == 8 || map.layer_bits == 16) &&
           map.stored_bricks() > 0 && map.stored_bricks() < VoxelMap::k_max_bricks &&
           fits(map.table, map.grid, map.stored_bricks(), std::numeric_limits<std::int32_t>::min());
  };
  return load_or_build(
      "vps-voxelmap", key, [&] { return VoxelMap::build(mesh, voxel_size, border); }, visit, valid);
}

PointShell prepare_pointshell(const Mesh& mesh, const Settings& settings) {
  const double spacing = settings.number("point_spacing") * mesh.diagonal();
  const std::string key = fmt::format("version 3, mesh {}, spacing {:a}", mesh.hash(), spacing);
  const auto visit = [](CacheMembers members, PointShell& shell) {
    members.records("points", shell.points);
    members.records("normals", shell.normals);
    members.array("areas", shell.areas);
  };
  const auto valid = [](const PointShell& shell) {
    return !shell.points.empty() && shell.points.size() == shell.normals.size() &&
           shell.points.size() == shell.areas.size() && all_finite(shell.points) && all_finite(shell.normals) &&
           all_finite(shell.areas);
  };
  return load_or_build(
      "vps-pointshell", key, [&] { return PointShell::build(mesh, spacing); }, visit, valid);
}

DistanceField prepare_field(const Mesh& mesh, const VoxelMap& map) {
  const std::string key =
      fmt::format("version 3, mesh {}, voxel size {:a}, border {}", mesh.hash(), map.grid.size, map.border);
  const auto visit = [&](CacheMembers members, DistanceField& field) {
    field.grid = map.grid;
    members.array("table", field.table);
    members.array("coefficients", field.coefficients);
  };
  const auto valid = [](const DistanceField& field) {
    return field.coefficients.size() == field.stored_bricks() * DistanceField::k_brick_coefficients + 1 &&
           fits(field.table, field.grid, field.stored_bricks(), 0);
  };
  return load_or_build(
      "vps-field", key, [&] { return DistanceField::build(mesh, map); }, visit, valid);
}

}  // namespace vps

namespace {

using namespace vps;

/// With more contacts than this the force of 1999 is a mean: McNeely et al. 1999, section 4.
constexpr double k_summed_contacts = 10.0;

/// A tree of points against a structure on a voxel grid: the layers of a voxelmap or, with `k_field`, a distance field.
template <bool k_field>
class PointQuery final : public Query {
 public:
  PointQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : points_on_b_(settings.choice("pointshell") == "b"),
        by_area_(settings.choice("weight") == "area"),
        culling_(settings.choice("culling") == "on"),
        stiffness_(settings.number("stiffness")),
        b_center_(b.center()),
        map_(prepare_voxelmap(points_on_b_ ? a : b, settings)),
        tree_(prepare_pointshell(points_on_b_ ? b : a, settings), (points_on_b_ ? b : a).center(), by_area_) {
    if constexpr (k_field) {
      field_ = prepare_field(points_on_b_ ? a : b, map_);
    } else if (settings.choice("depth") == "layers") {
      depth_ = LayerDepth::layers;
    }
    // Parts smaller than a voxel, and parts between points, are not seen.
    resolution_ =
        std::numbers::sqrt3 * map_.grid.size + settings.number("point_spacing") * (points_on_b_ ? b : a).diagonal();
    const Eigen::Vector3d box = (points_on_b_ ? a : b).box().sizes();
    box_voxels_ = (box.array() / map_.grid.size + 0.5).floor() + 1.0;
    all_leaves_.resize(culling_ ? 0 : tree_.leaves());
    std::iota(all_leaves_.begin(), all_leaves_.end(), 0u);
  }

  Outcome<bool> collide(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    const Pose X = points_on_b_ ? X_AB : X_AB.inverse();
    const VoxelTransform transform = VoxelTransform::of(X, tree_.center(), map_.grid);
    tested_leaves_ = 0;
    const auto test = [&](std::span<const std::uint32_t> leaves) {
      tested_leaves_ += leaves.size();
      if constexpr (k_field) {
        return touches_field(field_, {tree_, transform, leaves});
      } else {
        return touches_layers(map_, {tree_, transform, leaves});
      }
    };
    return culling_ ? tree_.any_leaves(map_, transform, k_reach, scratch_, test) : test(all_leaves_);
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    const Pose X = points_on_b_ ? X_AB : X_AB.inverse();
    const VoxelTransform transform = VoxelTransform::of(X, tree_.center(), map_.grid);
    const std::span<const std::uint32_t> leaves =
        culling_ ? tree_.cull(map_, transform, k_reach, scratch_) : std::span<const std::uint32_t>(all_leaves_);
    tested_leaves_ = leaves.size();
    Response response;
    if (!leaves.empty()) response = wrench_on_points(X, transform, leaves);
    response.reference = X * tree_.center();
    if (!points_on_b_) {
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
    Footprint footprint{
        .bytes = map_.bytes() + tree_.bytes() + field_.bytes() + all_leaves_.capacity() * sizeof(all_leaves_[0]),
        .counts = {{"voxels", map_.grid.voxel_count()},
                   {"voxels_x", box_voxels_.x()},
                   {"voxels_y", box_voxels_.y()},
                   {"voxels_z", box_voxels_.z()},
                   {"surface_voxels", static_cast<double>(map_.surface_voxels)},
                   {"inside_voxels", static_cast<double>(map_.inside_voxels)},
                   {"bricks", static_cast<double>(map_.stored_bricks())},
                   {"points", static_cast<double>(tree_.points())},
                   {"nodes", static_cast<double>(tree_.nodes())},
                   {"resolution", resolution_}}};
    if (k_field) footprint.counts.emplace_back("field_bricks", static_cast<double>(field_.stored_bricks()));
    return footprint;
  }

  /// All points of a leaf are tested.
  std::vector<Work> work() const override {
    const auto points = static_cast<double>(tree_.points());
    return {{"points", std::min(points, static_cast<double>(tested_leaves_ * PointTree::k_leaf_points)), points}};
  }

 private:
  static constexpr double k_reach = k_field ? DistanceField::k_reach : 0.0;

  /// In the voxels' frame.
  Response wrench_on_points(const Pose& X, const VoxelTransform& transform, std::span<const std::uint32_t> leaves) {
    const double size = map_.grid.size;
    ContactSums sums;
    Response response;
    if constexpr (k_field) {
      sums = sum_field(field_, {tree_, transform, leaves});
      // The energy is k sum w (s f)^2 / 2 with f and positions in voxels: a factor s for f, and another for the arm.
      response.force = stiffness_ * size * sums.force;
      response.torque = stiffness_ * size * size * sums.torque;
    } else {
      sums = sum_layers(map_, {tree_, transform, leaves}, depth_);
      response.force = stiffness_ * size * (X.R * sums.force);
      response.torque = stiffness_ * size * (X.R * sums.torque);
    }
    response.penalty = size * sums.depth;
    if (!by_area_) {
      const double divisor = std::max(1.0, sums.contacts / k_summed_contacts);
      response.force /= divisor;
      response.torque /= divisor;
    }
    return response;
  }

  const bool points_on_b_, by_area_, culling_;
  const double stiffness_;
  const Eigen::Vector3d b_center_;
  /// Voxels that the body's box spans along each axis; it begins in the middle of one.
  Eigen::Array3d box_voxels_ = Eigen::Array3d::Zero();
  double resolution_ = 0.0;  ///< How far the sampled surfaces may lie from the true ones (length).
  const VoxelMap map_;
  const PointTree tree_;
  DistanceField field_;                              ///< With `k_field`.
  LayerDepth depth_ = LayerDepth::layers_and_local;  ///< Without.
  std::vector<std::uint32_t> all_leaves_;            ///< Without culling.
  PointTree::Scratch scratch_;
  std::size_t tested_leaves_ = 0;  ///< By the last query.
};

Parameter voxel_size(const std::string& default_value) {
  return Parameter::number("voxel_size", "edge of a voxel, as a fraction of the diagonal of the voxelised body's box",
                           "diagonal", default_value, 0.0005, 0.1);
}

Parameter point_spacing(const std::string& default_value) {
  return Parameter::number("point_spacing",
                           "distance of neighbouring points, as a fraction of the diagonal of their body's box",
                           "diagonal", default_value, 0.0005, 0.1);
}

/// What `vps` and `vps-field` share.
std::vector<Parameter> common_parameters(const Parameter& voxel_size, const Parameter& point_spacing, int min_border) {
  return {
      voxel_size,
      point_spacing,
      {.name = "border",
       .meaning = "voxel layers outside the body that are stored; beyond them culling uses one distance per brick",
       .unit = "voxels",
       .default_value = "4",
       .low = static_cast<double>(min_border),
       .high = 64,
       .integer = true},
      Parameter::choice("weight",
                        "area: a point's weight is the area of its cell; contacts: it is 1, and the sum over more than "
                        "ten contacts is divided by a tenth of their number (1999)",
                        "area", {"area", "contacts"}),
      Parameter::choice("pointshell", "the body that has the points; the other one is voxelised", "b", {"b", "a"}),
      Parameter::number("stiffness", "factor k of force and torque", "force/length^3", "1", 1e-12, 1e12),
      Parameter::choice("culling",
                        "whether the point tree leaves out points without contact; changes no bit of an answer", "on",
                        {"on", "off"}),
  };
}

Traits traits(std::string name, std::string summary, ResponseLaw law, std::vector<Parameter> parameters) {
  return {
      .name = std::move(name),
      .version = SIXDOF_VERSION,
      .summary = std::move(summary),
      .answers = {.collide = true, .respond = true},
      .law = law,
      .approximates = true,
      // A is sampled at B's points only: none is in an A that lies inside B.
      .limits = {.surfaces_only = {.collide = true, .respond = true}, .own_direction = true, .points_of_b_only = true},
      .parameters = std::move(parameters)};
}

}  // namespace

std::unique_ptr<Algorithm> make_vps_algorithm() {
  std::vector<Parameter> parameters =
      common_parameters(voxel_size("0.004").swept({"0.032", "0.016", "0.008", "0.004", "0.002"}),
                        point_spacing("0.004").swept({"0.032", "0.016", "0.008", "0.004", "0.002"}), 0);
  parameters.insert(
      parameters.begin() + 2,
      Parameter::choice("depth",
                        "penetration of a point: the layer of its voxel, with or without its position in the voxel",
                        "layers+local", {"layers", "layers+local"}));
  return make_algorithm<PointQuery<false>>(
      traits("vps", "voxmap-pointshell: integer layers of A at points of B (McNeely 1999, Sagardia 2008)",
             ResponseLaw::depth, parameters));
}

std::unique_ptr<Algorithm> make_vps_field_algorithm() {
  return make_algorithm<PointQuery<true>>(traits(
      "vps-field", "points of B in a smooth signed distance to A: conservative, continuous voxmap-pointshell",
      ResponseLaw::way_out,
      common_parameters(voxel_size("0.008").swept({"0.032", "0.016", "0.008", "0.004"}),
                        point_spacing("0.004").swept({"0.016", "0.008", "0.004", "0.002"}), DistanceField::k_border)));
}

}  // namespace sixdof
