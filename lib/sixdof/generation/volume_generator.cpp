#include <sixdof/generation/volume_generator.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <sixdof/algorithm/preparation.h>
#include <sixdof/generation/overlap_bounds.h>
#include <sixdof/generation/overlap_march.h>
#include <sixdof/geometry/tree.h>
#include <sixdof/oracle/candidates.h>
#include <sixdof/oracle/overlap.h>
#include <sixdof/oracle/solid.h>

namespace sixdof {
namespace {

/// The part of a prepared pair that all threads use.
struct VolumePair {
  struct Body {
    explicit Body(const Mesh& mesh) : tree(mesh), solid(mesh, tree), areas(area_vectors(tree)) {}

    Tree tree;
    Solid solid;
    std::vector<Eigen::Vector3d> areas;
  };

  VolumePair(const Mesh& a, const Mesh& b)
      : mesh_a(a),
        mesh_b(b),
        body_a(std::make_shared<const Body>(a)),
        body_b(a.hash() == b.hash() ? body_a : std::make_shared<const Body>(b)) {}

  /// Of a volume (overlap.h). Few triangles are as large as the largest, so one of each body stands for those crossed.
  double rounding() const {
    constexpr double k_multiple = 1e-15;
    const auto largest = [](const Body& body) {
      double square = 0.0;
      for (const Eigen::Vector3d& area : body.areas) square = std::max(square, area.squaredNorm());
      return std::sqrt(square);
    };
    const double reach = mesh_a.diagonal() + mesh_b.diagonal() + mesh_a.center().norm() + mesh_b.center().norm();
    return k_multiple * reach * (largest(*body_a) + largest(*body_b));
  }

  const Mesh& mesh_a;
  const Mesh& mesh_b;
  std::shared_ptr<const Body> body_a, body_b;  // one for two copies of one mesh
};

class VolumeSolver final : public RaySolver {
 public:
  VolumeSolver(std::shared_ptr<const VolumePair> pair, std::unique_ptr<RaySolver> touching)
      : shared_(std::move(pair)),
        pair_(*shared_),
        touching_(std::move(touching)),
        touching_target_(distance_bucket(pair_.mesh_a, 0).target),
        query_(pair_.body_a->solid, pair_.body_b->solid),
        by_leaves_(bounds(SlopeBounds::Items::leaves)),
        by_triangles_(bounds(SlopeBounds::Items::triangles)) {}

  void set_rotation(const Eigen::Vector4d& rotation) override {
    ray_ = ConfigurationRay(pair_.mesh_a, pair_.mesh_b, rotation);
    touching_->set_rotation(rotation);
    first_step_ = k_first_step * std::min(pair_.mesh_a.diagonal(), pair_.mesh_b.diagonal());
    // The boxes exclude volumes for all directions. The margin covers the rounding of R.
    constexpr double k_above_rounding = 1.0 + 1e-9;
    const double bound = overlap_upper_bound(pair_.mesh_a.box().sizes(), pair_.mesh_b.box().sizes(), ray_.R);
    most_ = std::min({pair_.mesh_a.volume(), pair_.mesh_b.volume(),
                      k_above_rounding * bound + k_volume_tolerance * pair_.mesh_a.volume()});
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

    forget_pairs();
    OverlapMarch march(
        [&](double s, double front) { return measure(s, front); },
        [&](const OverlapMeasurement& outer, const OverlapMeasurement& inner, double enough) {
          return peak(outer, inner, enough);
        },
        contact,
        {.resolution = k_first_overlap_resolution * std::min(pair_.mesh_a.diagonal(), pair_.mesh_b.diagonal()),
         .tolerance = k_volume_tolerance * pair_.mesh_a.volume(),
         .first_step = first_step_,
         .rounding = pair_.rounding()});
    const std::size_t first = k;
    for (; k < targets.size() && targets[k] <= most_; ++k) {
      const std::optional<OverlapMeasurement> hit = march.advance(targets[k]);
      if (!hit) break;
      translations[k] = hit->s;
      residuals[k] = std::abs(hit->volume - targets[k]);
    }
    if (k > first) first_step_ = contact - translations[first];
  }

  std::uint64_t measurements() const override { return measurements_; }

 private:
  /// What may intersect is collected first, from the front to a little beyond s, and from there the candidates: the
  /// bounds between the front and the hit need the same pairs, and other measurements lie close by.
  OverlapMeasurement measure(double s, double front) {
    ++measurements_;
    if (!is_collected(s, front)) collect_leaves(std::max(0.0, s - k_beyond * (front - s)), front);
    if (!(selected_from_ >= s && s >= selected_to_)) select_candidates(s);
    const Overlap overlap = query_.evaluate(ray_.pose(s), ray_.center_a, candidates_, ray_.direction);
    return {
        .s = s, .volume = overlap.volume, .slope = -overlap.area.dot(ray_.direction), .curvature = overlap.curvature};
  }

  /// The candidates within a margin of s. Where parts are so small that floats and the margin blur them, nearly all
  /// triangles of their pairs of leaves are candidates: there only those at s, by a search in doubles.
  void select_candidates(double s) {
    const double margin = k_margin * std::min(pair_.mesh_a.diagonal(), pair_.mesh_b.diagonal());
    selected_from_ = std::min(outer_, s + margin);
    selected_to_ = std::max(inner_, s - margin);
    const FractionRange range{fraction(selected_from_), fraction(selected_to_)};
    const Tree &tree_a = pair_.body_a->tree, &tree_b = pair_.body_b->tree;
    if (has_triangles_) {
      select_pairs(triangles_, range, candidates_);
    } else if (!are_blurred_) {
      select_triangles(tree_a, tree_b, ray_.pose(s), margin, leaves_, range, candidates_);
    }
    are_blurred_ = are_blurred_ || candidates_.size() > k_most_per_leaves * leaves_.size();
    if (are_blurred_) {
      find_candidates(tree_a, tree_b, ray_.pose(s), scratch_, candidates_);
      selected_from_ = selected_to_ = s;
    }
  }

  SlopeBounds bounds(SlopeBounds::Items items) const {
    return {items, pair_.body_a->tree, pair_.body_a->areas, pair_.body_b->tree, pair_.body_b->areas};
  }

  /// Leaves mostly suffice, and are fewer.
  VolumePeak peak(const OverlapMeasurement& outer, const OverlapMeasurement& inner, double enough) {
    if (!is_collected(inner.s, outer.s)) collect_leaves(inner.s, outer.s);
    const VolumePeak of_leaves = peak(outer, inner, by_leaves_, leaves_);
    if (of_leaves.volume <= enough || is_cheaper_divided()) return of_leaves;
    if (!has_triangles_) collect_triangles();
    return peak(outer, inner, by_triangles_, triangles_);
  }

  /// Where leaves leave an interval in doubt, it is divided as long as the candidates of such measurements are fewer
  /// than half of the pairs of leaves, whose triangles would be the alternative.
  bool is_cheaper_divided() {
    if (has_triangles_) return false;
    const bool is_cheaper = 2 * of_doubts_ < leaves_.size();
    of_doubts_ += candidates_.size();
    return is_cheaper;
  }

  VolumePeak peak(const OverlapMeasurement& outer, const OverlapMeasurement& inner, SlopeBounds& bounds,
                  std::span<const SweptPair> swept) const {
    const auto ranges = bounds.bound(swept, ray_.direction, ray_.R.transpose() * ray_.direction, fraction(outer.s),
                                     fraction(inner.s), outer.slope, inner.slope);
    return volume_peak(outer, inner, ranges);
  }

  bool is_collected(double inner, double outer) const { return inner >= inner_ && outer <= outer_; }

  void forget_pairs() {
    inner_ = selected_to_ = std::numeric_limits<double>::infinity();
    outer_ = selected_from_ = -inner_;
    has_triangles_ = are_blurred_ = false;
    of_doubts_ = 0;
  }

  void collect_leaves(double inner, double outer) {
    forget_pairs();
    inner_ = inner;
    outer_ = outer;
    find_swept_leaves(pair_.body_a->tree, pair_.body_b->tree, ray_.pose(outer), (inner - outer) * ray_.direction,
                      scratch_, leaves_);
  }

  void collect_triangles() {
    has_triangles_ = true;
    find_swept_triangles(pair_.body_a->tree, pair_.body_b->tree, ray_.pose(outer_), (inner_ - outer_) * ray_.direction,
                         leaves_, triangles_);
  }

  double fraction(double s) const { return outer_ > inner_ ? (outer_ - s) / (outer_ - inner_) : 0.0; }

  /// Displacement from contact to the first measurement in a rotation's first direction, in units of the smaller box's
  /// diagonal. Other directions take the displacement at which the direction before met its first target.
  static constexpr double k_first_step = 0.02;

  /// Pairs are collected from the front to the next measurement and beyond by this fraction of the step.
  static constexpr double k_beyond = 0.05;
  /// Candidates serve measurements within this fraction of the smaller box's diagonal.
  static constexpr double k_margin = 4e-6;
  /// Candidates per pair of leaves, more than which mean that they are blurred. Elsewhere there are at most 1.2.
  static constexpr std::size_t k_most_per_leaves = 4;

  const std::shared_ptr<const VolumePair> shared_;
  const VolumePair& pair_;
  std::unique_ptr<RaySolver> touching_;
  double touching_target_;
  ConfigurationRay ray_;
  double first_step_ = 0.0;
  double most_ = 0.0;  ///< Upper bound on the overlap in this rotation.
  std::uint64_t measurements_ = 0;
  OverlapQuery query_;
  SlopeBounds by_leaves_, by_triangles_;
  double outer_ = 0.0, inner_ = 0.0;  ///< Pairs are collected between these translations of the ray.
  CandidateScratch scratch_;
  std::vector<SweptPair> leaves_, triangles_;
  bool has_triangles_ = false;
  std::size_t of_doubts_ = 0;  ///< Candidates of the measurements by which intervals of these were divided.
  bool are_blurred_ = false;
  double selected_from_ = 0.0, selected_to_ = 0.0;  ///< The candidates are those between these translations.
  std::vector<TrianglePair> candidates_;
};

}  // namespace

std::function<std::unique_ptr<RaySolver>()> volume_solvers(const DistanceGenerator& touching, const Mesh& a,
                                                           const Mesh& b) {
  for (const Mesh* mesh : {&a, &b}) require_solid(*mesh, "an overlap volume");
  return [&touching, pair = std::make_shared<const VolumePair>(a, b)] {
    return std::make_unique<VolumeSolver>(pair, touching.prepare(pair->mesh_a, pair->mesh_b));
  };
}

Generated generate_volumes(const DistanceGenerator& touching, const Mesh& a, const Mesh& b, const Grid& grid,
                           std::span<const double> percents, const RunOptions& run,
                           std::span<const std::uint32_t> rotations) {
  std::vector<BucketSummary> summaries;
  for (const double percent : percents) {
    BucketSummary summary = volume_bucket(a, percent);
    const bool contact = percent == 0.0;
    summary.oracle = contact ? touching.oracle_name() : "exact";
    summary.oracle_version = contact ? touching.oracle_version() : SIXDOF_VERSION;
    summaries.push_back(std::move(summary));
  }
  return detail::sweep_rotations(volume_solvers(touching, a, b), grid, summaries, run, rotations);
}

}  // namespace sixdof
