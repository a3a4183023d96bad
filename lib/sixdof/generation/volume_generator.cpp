#include <sixdof/generation/volume_generator.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/generation/overlap_ceiling.h>
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

/// What all threads share of a pair.
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
  // Absent for copies of one mesh.
  std::optional<Tree> tree_b;
  std::optional<Solid> solid_b;
  std::vector<Eigen::Vector3d> areas_b;
};

namespace {

using detail::VolumePair;

/// The overlap along one ray. Pairs of triangles that may meet are collected once for many measurements.
class OverlapRay {
 public:
  explicit OverlapRay(const VolumePair& pair)
      : pair_(pair),
        query_(pair.solid_a, pair.solid_of_b()),
        bounds_(pair.tree_a.corners().size(), pair.tree_of_b().corners().size()) {}

  /// In units of some 20 ns, near those of the ray cast: within a factor of two of the time of nearly all rays, but up
  /// to five times as long where many faces coincide, whose crossings take exact arithmetic.
  std::uint64_t work() const { return work_; }

  void set(const ConfigurationRay& ray) {
    ray_ = ray;
    outer_ = inner_ = -1.0;  // nothing is collected
  }

  OverlapSample measure(double s, double outer) {
    if (s < inner_ || s > outer_) collect(std::max(0.0, s - k_foresight * (outer - s)), outer);
    select_candidates(swept_, share(s), pairs_);
    work_ += k_selecting + k_crossing * pairs_.size() + swept_.pairs.size() / k_scanned_per_unit;
    const Overlap overlap = query_.evaluate(ray_.pose(s), ray_.center_a, pairs_);
    return {.s = s, .volume = overlap.volume, .slope = -overlap.area.dot(ray_.direction)};
  }

  VolumePeak peak(const OverlapSample& outer, const OverlapSample& inner) {
    if (inner.s < inner_ || outer.s > outer_) collect(inner.s, outer.s);
    work_ += swept_.pairs.size() / k_scanned_per_unit;
    const auto ranges =
        bounds_.bound(swept_, pair_.areas_a, pair_.areas_of_b(), ray_.direction, ray_.R.transpose() * ray_.direction,
                      share(outer.s), share(inner.s), outer.slope, inner.slope);
    return volume_peak(outer, inner, ranges);
  }

 private:
  /// Collects this much more than the way up to a measurement, for those that come after.
  static constexpr double k_foresight = 0.03;

  // Units of work per measurement, pair that may meet at its place, pair collected; pairs looked through per unit.
  static constexpr std::uint64_t k_selecting = 4, k_crossing = 6, k_collecting = 2, k_scanned_per_unit = 8;

  void collect(double inner, double outer) {
    inner_ = inner;
    outer_ = outer;
    find_swept_candidates(pair_.tree_a, pair_.tree_of_b(), ray_.pose(outer), (inner - outer) * ray_.direction, swept_);
    work_ += k_collecting * swept_.pairs.size();
  }
  double share(double s) const { return outer_ > inner_ ? (outer_ - s) / (outer_ - inner_) : 0.0; }

  const VolumePair& pair_;
  OverlapQuery query_;
  SlopeBounds bounds_;
  ConfigurationRay ray_;
  double outer_ = -1.0, inner_ = -1.0;  ///< Between these translations pairs are collected.
  SweptCandidates swept_;
  std::vector<CandidatePair> pairs_;
  std::uint64_t work_ = 0;
};

class VolumeSolver final : public RaySolver {
 public:
  VolumeSolver(const VolumePair& pair, std::unique_ptr<RaySolver> touching)
      : pair_(pair), touching_(std::move(touching)), overlap_(pair), touching_target_(distance_bucket(pair.a, 0).target) {}

  void set_rotation(const Eigen::Vector4d& rotation) override {
    ray_ = ConfigurationRay(pair_.a, pair_.b, rotation);
    touching_->set_rotation(rotation);
    first_stride_ = k_first_stride * std::min(pair_.a.diagonal(), pair_.b.diagonal());
    // Boxes turned by R exclude volumes for all directions; the room covers the rounding of R.
    constexpr double k_room = 1.0 + 1e-9;
    const double ceiling = overlap_ceiling(pair_.a.box().sizes(), pair_.b.box().sizes(), ray_.R);
    most_ = std::min({pair_.a.volume(), pair_.b.volume(), k_room * ceiling + k_volume_tolerance * pair_.a.volume()});
  }

  void solve(const Eigen::Vector3d& direction, std::span<const double> targets, std::span<double> translations,
             std::span<double> residuals) override {
    ray_.direction = direction;
    std::ranges::fill(translations, std::numeric_limits<double>::quiet_NaN());
    std::ranges::fill(residuals, 0.0);
    double contact = 0.0, contact_residual = 0.0;
    touching_->solve(direction, {&touching_target_, 1}, {&contact, 1}, {&contact_residual, 1});
    work_.assign(targets.size(), 0);
    work_.front() = touching_->work().front();
    if (std::isnan(contact)) return;  // Surfaces that never touch enclose nothing together: B comes from outside.
    std::size_t k = 0;
    for (; k < targets.size() && targets[k] == 0.0; ++k) translations[k] = contact;
    if (k == targets.size() || targets[k] > most_) return;

    overlap_.set(ray_);
    OverlapMarch march(
        [&](double s, double outer) { return overlap_.measure(s, outer); },
        [&](const OverlapSample& outer, const OverlapSample& inner) { return overlap_.peak(outer, inner); }, contact,
        {.resolution = k_first_overlap_resolution * std::min(pair_.a.diagonal(), pair_.b.diagonal()),
         .tolerance = k_volume_tolerance * pair_.a.volume(),
         .first_stride = first_stride_});
    const std::size_t first = k;
    for (; k < targets.size() && targets[k] <= most_; ++k) {
      const std::uint64_t before = overlap_.work();
      const std::optional<OverlapSample> hit = march.advance(targets[k]);
      work_[k] += overlap_.work() - before;
      if (!hit) break;
      translations[k] = hit->s;
      residuals[k] = std::abs(hit->volume - targets[k]);
    }
    if (k > first) first_stride_ = contact - translations[first];
    measurements_ += static_cast<std::uint64_t>(march.measurements());
  }

  std::uint64_t measurements() const override { return measurements_; }
  std::span<const std::uint64_t> work() const override { return work_; }

 private:
  /// Where a rotation's first direction is measured first, in units of the smaller box's diagonal; the others begin
  /// where the direction before them met its first target.
  static constexpr double k_first_stride = 0.02;

  const VolumePair& pair_;
  std::unique_ptr<RaySolver> touching_;
  OverlapRay overlap_;
  double touching_target_;
  ConfigurationRay ray_;
  double first_stride_ = 0.0;
  double most_ = 0.0;  ///< No overlap of this rotation is larger.
  std::uint64_t measurements_ = 0;
  std::vector<std::uint64_t> work_;  // of each target
};

}  // namespace

VolumeGenerator::VolumeGenerator(const DistanceGenerator& touching, const Mesh& a, const Mesh& b)
    : touching_(touching), oracle_version_(SIXDOF_VERSION), pair_(std::make_unique<const VolumePair>(a, b)) {}

VolumeGenerator::~VolumeGenerator() = default;

std::unique_ptr<RaySolver> VolumeGenerator::prepare() const {
  return std::make_unique<VolumeSolver>(*pair_, touching_.prepare(pair_->a, pair_->b));
}

Generated generate_volumes(const DistanceGenerator& touching, const Mesh& a, const Mesh& b, const Grid& grid,
                           std::span<const int> percents, const GenerateOptions& options) {
  Generated result;
  for (const int percent : percents) result.buckets.push_back({.summary = volume_bucket(a, percent), .translations = {}});
  // From contact inwards: a ray meets them in this order.
  detail::order_buckets(result.buckets, false, detail::rotations_asked(grid, options) * grid.directions.size());
  const VolumeGenerator generator(touching, a, b);
  result.measurements = detail::sweep_rotations([&] { return generator.prepare(); }, grid, result.buckets, options);
  for (Bucket& bucket : result.buckets) {
    const bool contact = bucket.summary.key.percent == 0;
    bucket.summary.oracle = contact ? touching.oracle_name() : generator.oracle_name();
    bucket.summary.oracle_version = contact ? touching.oracle_version() : generator.oracle_version();
  }
  std::ranges::sort(result.buckets, {}, [&](const Bucket& bucket) {
    return std::ranges::find(percents, bucket.summary.key.percent) - percents.begin();
  });
  return result;
}

}  // namespace sixdof
