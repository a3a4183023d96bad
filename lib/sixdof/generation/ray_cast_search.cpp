#include <sixdof/generation/ray_cast_search.h>

#include <algorithm>

#include <sixdof/generation/ray_cast_update.h>

namespace sixdof::ray_cast {
namespace {

/// Length of the first interval in which a hit is searched for behind that of a larger target, in units of what the
/// slope of its distance predicts; and by what the interval grows.
constexpr double k_first_interval = 2.0;
constexpr double k_interval_growth = 2.0;

}  // namespace

void RaySearch::clear() {
  cast_.clear();
  last_ray_.clear();
}

void RaySearch::start_ray(const Eigen::Vector3d& direction, std::size_t targets) {
  cast_.direction = direction;
  cast_.front.clear();
  last_.reset();
  last_ray_.resize(targets);
  next_ = 0;
  reachable_ = true;
}

const Hit* RaySearch::find_next(double target) {
  const std::size_t index = next_++;
  if (!reachable_) return nullptr;  // a larger target has no hit, so this has none
  cast_.target = target;
  search_from(-k_cast_tie * cast_.size(), cast_.direction);
  if (last_) try_update(cast_, *last_->hit.pair);
  if (last_ray_[index]) try_update(cast_, *last_ray_[index]);
  if (!last_ || !find_behind(*last_)) find_first_hit(cast_);
  reachable_ = cast_.best.pair.has_value();
  if (!reachable_) return nullptr;
  last_ = {target, cast_.best};
  last_ray_[index] = cast_.best.pair;
  return &cast_.best;
}

/// Resets the best hit: there is none, and only larger translations are of interest.
void RaySearch::search_from(double translation, const Eigen::Vector3d& axis) {
  cast_.best = {.translation = translation, .pair = {}, .axis = axis, .separating_axis = axis};
}

/// Searches growing intervals behind the hit of a larger target, as long as they do not reach the best hit. A hit is
/// usually a little behind, and a search from far behind expands much in vain.
/// @return whether there was a hit; if not, the best hit is unchanged
bool RaySearch::find_behind(const LastTarget& last) {
  const Hit guess = cast_.best;
  const double slope = last.hit.axis.dot(cast_.direction);
  // Equal targets predict 0, which could not grow.
  double interval = std::max(k_first_interval * (last.target - cast_.target) / slope, k_cast_tie * cast_.size());
  for (; last.hit.translation - interval > guess.translation; interval *= k_interval_growth) {
    search_from(last.hit.translation - interval, last.hit.axis);
    find_first_hit(cast_);
    if (cast_.best.pair) return true;
  }
  cast_.best = guess;
  return false;
}

}  // namespace sixdof::ray_cast
