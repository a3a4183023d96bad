#include <sixdof/measure/contact_score.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <sixdof/measure/direction.h>
#include <sixdof/query/contacts.h>

namespace sixdof {
namespace {

using Eigen::Vector3d;

std::size_t stride(std::size_t count) {
  return std::max<std::size_t>(1, (count + k_most_judged_contacts - 1) / k_most_judged_contacts);
}

double distance_to(const Vector3d& p, std::span<const Vector3d> points) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vector3d& each : points) nearest = std::min(nearest, (each - p).squaredNorm());
  return std::sqrt(nearest);
}

/// The largest distance of one of `from` to the nearest of `to`; 0 if either is empty.
double farthest(std::span<const Vector3d> from, std::span<const Vector3d> to) {
  if (to.empty()) return 0.0;
  double largest = 0.0;
  for (const Vector3d& p : from) largest = std::max(largest, distance_to(p, to));
  return largest;
}

struct Neighbour {
  double distance = std::numeric_limits<double>::infinity();
  double angle = 180.0;
};

/// The contact of `others` nearest to `contact`.
Neighbour nearest(const Contact& contact, const std::vector<Contact>& others, double near) {
  Neighbour found;
  for (const Contact& each : others) found.distance = std::min(found.distance, (each.point - contact.point).norm());
  for (const Contact& each : others) {
    if ((each.point - contact.point).norm() <= found.distance + near) {
      found.angle = std::min(found.angle, angle_degrees(each.normal, contact.normal));
    }
  }
  return found;
}

}  // namespace

ContactScore score_contacts(const Contacts& contacts, ContactTruth& truth, double resolution) {
  const double diagonal = truth.diagonal(), slack = k_contact_slack * diagonal + resolution;
  ContactScore score{.count = contacts.list.size()};
  std::vector<Vector3d> points;
  for (const Contact& each : contacts.list) points.push_back(each.point);
  for (std::size_t i = 0; i < contacts.list.size(); i += stride(contacts.list.size())) {
    const Contact& contact = contacts.list[i];
    const JudgedContact judged = truth.judge(contact, resolution);
    ++score.judged;
    score.off_sum += judged.off() / diagonal;
    score.off_max = std::max(score.off_max, judged.off() / diagonal);
    score.off_bodies += std::min(judged.outside_a, judged.outside_b) > slack ? 1 : 0;
    score.normal_sum += judged.normal_angle;
    score.normal_max = std::max(score.normal_max, judged.normal_angle);
    score.reversed += judged.is_reversed() ? 1 : 0;
    score.depth_sum += std::max(0.0, contact.depth) / diagonal;
    score.thickness_sum += judged.thickness / diagonal;
  }
  const Vector3d normal = mean_normal(contacts), force = truth.force_direction();
  if (!normal.isZero(0.0) && !force.isZero(0.0)) score.force_angle = angle_degrees(normal, force);
  if (points.empty()) return score;
  const std::vector<Vector3d> true_points = truth.truth_points();
  score.uncovered = farthest(true_points, points) / diagonal;
  score.astray = farthest(points, true_points) / diagonal;
  return score;
}

ContactChange compare_contacts(const Contacts& x, const Contacts& y, double diagonal) {
  ContactChange change{.is_other_number = x.list.size() != y.list.size()};
  change.is_comparable = x.list.empty() == y.list.empty();
  if (!change.is_comparable || x.list.empty()) return change;
  double of_both = 0.0;
  for (const auto& [from, to] : {std::pair(&x.list, &y.list), {&y.list, &x.list}}) {
    double points = 0.0, angles = 0.0, count = 0.0;
    for (std::size_t i = 0; i < from->size(); i += stride(from->size())) {
      const Neighbour found = nearest((*from)[i], *to, k_contact_slack * diagonal);
      points += found.distance / diagonal;
      angles += found.angle;
      change.flips += found.angle > 90.0 ? 1 : 0;
      count += 1.0;
    }
    change.points += 0.5 * points / count;
    of_both += 0.5 * angles / count;
  }
  change.normal_angle = of_both;
  change.mean_normal_angle = angle_degrees(mean_normal(x), mean_normal(y));
  return change;
}

void ContactScores::Values::add(double value) {
  sum += value;
  largest = std::max(largest, value);
  ++count;
}

void ContactScores::Changes::add(const std::optional<ContactChange>& change) {
  if (!change) {
    ++failed;
    return;
  }
  other_numbers += change->is_other_number ? 1 : 0;
  if (!change->is_comparable) return;
  points.add(change->points);
  normals.add(change->normal_angle);
  mean_normals.add(change->mean_normal_angle);
  flips += change->flips;
}

void ContactScores::add(const ContactScore& score) {
  ++scored_;
  faulty_ += score.is_faulty() ? 1 : 0;
  without_ += score.count == 0 ? 1 : 0;
  counts_.add(static_cast<double>(score.count));
  judged_ += score.judged;
  off_bodies_ += score.off_bodies;
  reversed_ += score.reversed;
  off_sum_ += score.off_sum;
  off_max_ = std::max(off_max_, score.off_max);
  normal_sum_ += score.normal_sum;
  normal_max_ = std::max(normal_max_, score.normal_max);
  depth_sum_ += score.depth_sum;
  thickness_sum_ += score.thickness_sum;
  if (score.force_angle) force_angles_.add(*score.force_angle);
  if (score.count == 0) return;
  uncovered_.add(score.uncovered);
  astray_.add(score.astray);
}

void ContactScores::add_step(const ContactChange& change, double force_angle, double center) {
  steps_.add(change);
  step_forces_.add(force_angle);
  step_centers_.add(center);
}

void ContactScores::for_each(const std::function<void(std::string_view, double)>& use) const {
  const auto both = [&](std::string_view mean, std::string_view largest, const Values& values) {
    if (values.count == 0) return;
    use(mean, values.mean());
    use(largest, values.largest);
  };
  both("contacts_mean", "contacts_max", counts_);
  use("without_contact", static_cast<double>(without_));
  use("judged_contacts", static_cast<double>(judged_));
  use("off_bodies", static_cast<double>(off_bodies_));
  use("reversed_normals", static_cast<double>(reversed_));
  if (judged_ > 0) {
    const auto judged = static_cast<double>(judged_);
    use("contact_off_mean", off_sum_ / judged);
    use("contact_off_max", off_max_);
    use("contact_normal_deg", normal_sum_ / judged);
    use("contact_normal_max_deg", normal_max_);
  }
  if (thickness_sum_ > 0.0) use("contact_depth_ratio", depth_sum_ / thickness_sum_);
  both("contact_force_deg", "contact_force_max_deg", force_angles_);
  both("uncovered_mean", "uncovered_max", uncovered_);
  both("astray_mean", "astray_max", astray_);
  const auto changes = [&](const std::array<std::string_view, 5>& names, const Changes& of) {
    if (of.points.count + of.other_numbers + of.failed == 0) return;
    use(names[0], of.normals.mean());
    use(names[1], static_cast<double>(of.flips));
    use(names[2], of.points.mean());
    use(names[3], static_cast<double>(of.other_numbers));
    use(names[4], static_cast<double>(of.failed));
  };
  changes({"exchange_normal_deg", "exchange_flips", "exchange_points", "exchange_number", "exchange_failed"},
          exchange_);
  changes({"moved_normal_deg", "moved_flips", "moved_points", "moved_number", "moved_failed"}, motion_);
  both("step_normal_deg", "step_normal_max_deg", steps_.mean_normals);
  both("step_points_mean", "step_points_max", steps_.points);
  both("step_force_deg", "step_force_max_deg", step_forces_);
  both("step_center_mean", "step_center_max", step_centers_);
}

}  // namespace sixdof
