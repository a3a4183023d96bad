#include <sixdof/generation/volume_generator.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/generation/overlap_bound.h>
#include <sixdof/generation/overlap_march.h>
#include <sixdof/generation/rotation_sweep.h>
#include <sixdof/generation/slope_bounds.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/solid.h>
#include <sixdof/oracle/swept_candidates.h>

namespace sixdof {
namespace {

const Mesh& solid_mesh(const Mesh& mesh) {
  if (mesh.solid()) return mesh;
  throw BadMesh(fmt::format("{}: an overlap volume needs a solid: {}", mesh.name(), mesh.why_not_solid()));
}

}  // namespace

/// The part of a prepared pair that all threads use.
struct detail::VolumePair {
  VolumePair(const Mesh& mesh_a, const Mesh& mesh_b)
      : a(solid_mesh(mesh_a)), b(solid_mesh(mesh_b)), tree_a(a), solid_a(a, tree_a), areas_a(area_vectors(tree_a)) {
    if (a.hash() == b.hash()) return;
    tree_b.emplace(b);
    solid_b.emplace(b, *tree_b);
    areas_b = area_vectors(*tree_b);
  }

  const Tree& tree_of_b() const { return tree_b ? *tree_b : tree_a; }
  const Solid& solid_of_b() const { return solid_b ? *solid_b : solid_a; }
  std::span<const Eigen::Vector3d> areas_of_b() const { return tree_b ? areas_b : areas_a; }

  const Mesh& a;
  const Mesh& b;
  Tree tree_a;
  Solid solid_a;
  std::vector<Eigen::Vector3d> areas_a;
  // Empty for two copies of one mesh.
  std::optional<Tree> tree_b;
  std::optional<Solid> solid_b;
  std::vector<Eigen::Vector3d> areas_b;
};

namespace {

using detail::VolumePair;

/// The overlap along one ray. Pairs of triangles that may intersect are collected once for many measurements.
class OverlapRay {
 public:
  explicit OverlapRay(const VolumePair& pair)
      : pair_(pair),
        query_(pair.solid_a, pair.solid_of_b()),
        bounds_(pair.tree_a.corners().size(), pair.tree_of_b().corners().size()) {}

  void set(const ConfigurationRay& ray) {
    ray_ = ray;
    outer_ = inner_ = -1.0;  // Nothing is collected.
  }

  OverlapMeasurement measure(double s, double outer) {
    if (s < inner_ || s > outer_) collect(std::max(0.0, s - k_margin * (outer - s)), outer);
    select_candidates(swept_, fraction(s), pairs_);
    const Overlap overlap = query_.evaluate(ray_.pose(s), ray_.center_a, pairs_);
    return {.s = s, .volume = overlap.volume, .slope = -overlap.area.dot(ray_.direction)};
  }

  VolumePeak peak(const OverlapMeasurement& outer, const OverlapMeasurement& inner) {
    if (inner.s < inner_ || outer.s > outer_) collect(inner.s, outer.s);
    const auto ranges =
        bounds_.bound(swept_, pair_.areas_a, pair_.areas_of_b(), ray_.direction, ray_.R.transpose() * ray_.direction,
                      fraction(outer.s), fraction(inner.s), outer.slope, inner.slope);
    return volume_peak(outer, inner, ranges);
  }

 private:
  /// Candidates are collected this much farther inwards than a measurement needs, for the next ones. A fraction of the
  /// displacement to it.
  static constexpr double k_margin = 0.03;

  void collect(double inner, double outer) {
    inner_ = inner;
    outer_ = outer;
    find_swept_candidates(pair_.tree_a, pair_.tree_of_b(), ray_.pose(outer), (inner - outer) * ray_.direction, swept_);
  }
  double fraction(double s) const { return outer_ > inner_ ? (outer_ - s) / (outer_ - inner_) : 0.0; }

  const VolumePair& pair_;
  OverlapQuery query_;
  SlopeBounds bounds_;
  ConfigurationRay ray_;
  double outer_ = -1.0, inner_ = -1.0;  ///< Candidates are collected between these translations.
  SweptCandidates swept_;
  std::vector<TrianglePair> pairs_;
};

class VolumeSolver final : public RaySolver {
 public:
  VolumeSolver(const VolumePair& pair, std::unique_ptr<RaySolver> touching)
      : pair_(pair),
        touching_(std::move(touching)),
        overlap_(pair),
        touching_target_(distance_bucket(pair.a, 0).target) {}

  void set_rotation(const Eigen::Vector4d& rotation) override {
    ray_ = ConfigurationRay(pair_.a, pair_.b, rotation);
    touching_->set_rotation(rotation);
    first_step_ = k_first_step * std::min(pair_.a.diagonal(), pair_.b.diagonal());
    // The boxes exclude volumes for all directions. The margin covers the rounding of R.
    constexpr double k_margin = 1.0 + 1e-9;
    const double bound = overlap_upper_bound(pair_.a.box().sizes(), pair_.b.box().sizes(), ray_.R);
    most_ = std::min({pair_.a.volume(), pair_.b.volume(), k_margin * bound + k_volume_tolerance * pair_.a.volume()});
  }

  void solve(const Eigen::Vector3d& direction, std::span<const double> targets, std::span<double> translations,
             std::span<double> residuals) override {
    ray_.direction = direction;
    std::ranges::fill(translations, std::numeric_limits<double>::quiet_NaN());
    std::ranges::fill(residuals, 0.0);
    double contact = 0.0, contact_residual = 0.0;
    touching_->solve(direction, {&touching_target_, 1}, {&contact, 1}, {&contact_residual, 1});
    if (std::isnan(contact)) return;  // B comes from outside: without contact there is no overlap.
    std::size_t k = 0;
    for (; k < targets.size() && targets[k] == 0.0; ++k) translations[k] = contact;
    if (k == targets.size() || targets[k] > most_) return;

    overlap_.set(ray_);
    OverlapMarch march(
        [&](double s, double outer) { return overlap_.measure(s, outer); },
        [&](const OverlapMeasurement& outer, const OverlapMeasurement& inner) { return overlap_.peak(outer, inner); },
        contact,
        {.resolution = k_first_overlap_resolution * std::min(pair_.a.diagonal(), pair_.b.diagonal()),
         .tolerance = k_volume_tolerance * pair_.a.volume(),
         .first_step = first_step_});
    const std::size_t first = k;
    for (; k < targets.size() && targets[k] <= most_; ++k) {
      const std::optional<OverlapMeasurement> hit = march.advance(targets[k]);
      if (!hit) break;
      translations[k] = hit->s;
      residuals[k] = std::abs(hit->volume - targets[k]);
    }
    if (k > first) first_step_ = contact - translations[first];
    measurements_ += static_cast<std::uint64_t>(march.measurements());
  }

  std::uint64_t measurements() const override { return measurements_; }

 private:
  /// Displacement from contact to the first measurement in a rotation's first direction, in units of the smaller box's
  /// diagonal. Other directions take the displacement at which the direction before met its first target.
  static constexpr double k_first_step = 0.02;

  const VolumePair& pair_;
  std::unique_ptr<RaySolver> touching_;
  OverlapRay overlap_;
  double touching_target_;
  ConfigurationRay ray_;
  double first_step_ = 0.0;
  double most_ = 0.0;  ///< Upper bound on the overlap in this rotation.
  std::uint64_t measurements_ = 0;
};

}  // namespace

VolumeGenerator::VolumeGenerator(const DistanceGenerator& touching, const Mesh& a, const Mesh& b)
    : touching_(touching), pair_(std::make_unique<const VolumePair>(a, b)) {}

VolumeGenerator::~VolumeGenerator() = default;

std::unique_ptr<RaySolver> VolumeGenerator::prepare() const {
  return std::make_unique<VolumeSolver>(*pair_, touching_.prepare(pair_->a, pair_->b));
}

Generated generate_volumes(const DistanceGenerator& touching, const Mesh& a, const Mesh& b, const Grid& grid,
                           std::span<const int> percents, const RunOptions& run,
                           std::span<const std::uint32_t> rotations) {
  std::vector<BucketSummary> summaries;
  for (const int percent : percents) {
    BucketSummary summary = volume_bucket(a, percent);
    const bool contact = percent == 0;
    summary.oracle = contact ? touching.oracle_name() : "exact";
    summary.oracle_version = contact ? touching.oracle_version() : SIXDOF_VERSION;
    summaries.push_back(std::move(summary));
  }
  const VolumeGenerator generator(touching, a, b);
  return detail::sweep_rotations([&] { return generator.prepare(); }, grid, summaries, run, rotations);
}

}  // namespace sixdof
