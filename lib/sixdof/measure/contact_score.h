#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>

#include <sixdof/oracle/contact_truth.h>
#include <sixdof/query/algorithm.h>

/// Scores of contacts against exact geometry, and of two answers against each other. Lengths are in diagonals of A's
/// box, angles in degrees.

namespace sixdof {

/// Contacts of one answer that are judged or compared at most: if there are more, every second, third, ...
inline constexpr std::size_t k_most_judged_contacts = 128;

/// The contacts of one pose of bodies that overlap.
struct ContactScore {
  std::size_t count = 0;       ///< Contacts of the answer.
  std::size_t judged = 0;      ///< Of them those that all that follows is about.
  double off_sum = 0.0;        ///< Sum of JudgedContact::off().
  double off_max = 0.0;        ///< The largest of them.
  double normal_sum = 0.0;     ///< Sum of JudgedContact::normal_angle.
  double normal_max = 0.0;     ///< The largest of them.
  std::size_t off_bodies = 0;  ///< Contacts that lie off both bodies: by more than k_contact_slack.
  std::size_t reversed = 0;    ///< JudgedContact::is_reversed().
  double depth_sum = 0.0;      ///< Sum of the depths above 0.
  double thickness_sum = 0.0;  ///< Sum of JudgedContact::thickness of these contacts.
  /// Of the mean normal to the exact force; none where either is zero.
  std::optional<double> force_angle = {};
  /// Distance of the point of ContactTruth::truth_points() that is farthest from all contacts.
  double uncovered = 0.0;
  double astray = 0.0;  ///< The reverse: of the contact that is farthest from all of those points.

  /// None though the bodies overlap, one off both of them, or one reversed.
  bool is_faulty() const { return count == 0 || off_bodies > 0 || reversed > 0; }
};

/// @param truth at the pose
/// @param resolution of an algorithm that approximates the bodies (length); 0 of others
ContactScore score_contacts(const Contacts& contacts, ContactTruth& truth, double resolution = 0.0);

/// How two answers differ that should be the same, or follow each other.
struct ContactChange {
  /// Mean over the contacts of both of the distance to the nearest contact of the other: the modified Hausdorff
  /// distance of Dubuisson and Jain (ICPR 1994), with the mean of both ways in place of the larger one.
  double points = 0.0;
  /// Mean angle of a normal to that of the nearest contact of the other; of several that are as near to k_contact_slack
  /// the nearest normal counts, since triangles that share a corner give several contacts there.
  double normal_angle = 0.0;
  std::size_t flips = 0;           ///< Such angles above 90 degrees.
  double mean_normal_angle = 0.0;  ///< Between the mean normals of both; 0 where one is zero.
  bool is_other_number = false;    ///< The numbers of contacts differ.
  bool is_comparable = true;       ///< Both have contacts, or none has; else only is_other_number is set.
};

/// @param diagonal of A's box (length)
ContactChange compare_contacts(const Contacts& x, const Contacts& y, double diagonal);

/// Sums over the poses of a row.
class ContactScores {
 public:
  /// A pose.
  void add(const ContactScore& score);
  /// Of (A, B) and of (B, A), both in A's frame; none if (B, A) has no answer.
  void add_exchange(const std::optional<ContactChange>& change) { exchange_.add(change); }
  /// Before and after a rigid motion of both bodies, both in A's frame; none if there is no answer after it.
  void add_motion(const std::optional<ContactChange>& change) { motion_.add(change); }
  /// Of two successive poses of a path.
  /// @param force_angle between the exact forces of both; @param center how far the exact centre of the intersection
  /// moves
  void add_step(const ContactChange& change, double force_angle, double center);

  /// Poses that were added.
  std::size_t scored() const { return scored_; }
  /// Of them those with a fault, ContactScore::is_faulty().
  std::size_t faulty() const { return faulty_; }

  /// Calls use(counter, value) for all of which there are values; measure/metrics.h explains the counters.
  void for_each(const std::function<void(std::string_view counter, double value)>& use) const;

 private:
  /// Sum and largest one of some values.
  struct Values {
    double sum = 0.0, largest = 0.0;
    std::size_t count = 0;
    void add(double value);
    double mean() const { return count == 0 ? 0.0 : sum / static_cast<double>(count); }
  };
  struct Changes {
    Values points, normals, mean_normals;
    std::size_t flips = 0, other_numbers = 0, failed = 0;
    void add(const std::optional<ContactChange>& change);
  };

  std::size_t scored_ = 0, faulty_ = 0, without_ = 0, judged_ = 0, off_bodies_ = 0, reversed_ = 0;
  double off_sum_ = 0.0, off_max_ = 0.0, normal_sum_ = 0.0, normal_max_ = 0.0, depth_sum_ = 0.0, thickness_sum_ = 0.0;
  Values counts_, force_angles_, uncovered_, astray_, step_forces_, step_centers_;
  Changes exchange_, motion_, steps_;
};

}  // namespace sixdof
