#include <sixdof/algorithm/core_algorithms.h>

#include <algorithm>
#include <cmath>

#include <sixdof/oracle/contact_truth.h>

namespace sixdof {
namespace {

/// Cosines up to this are of a right angle: the line along either normal runs in the other surface.
constexpr double k_right_angle = 1e-6;

class ExactContactsQuery final : public Query {
 public:
  ExactContactsQuery(const Mesh& a, const Mesh& b, const Settings& /*settings*/) : truth_(a, b) {}

  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override {
    if (!is_finite(X_AB)) return fail(Status::non_finite, "the pose is not finite");
    truth_.move_to(X_AB);
    std::vector<Contact> all;
    for (const InnerVertex& each : truth_.inner_vertices()) {
      all.push_back({each.point, each.normal, truth_.thickness(each.point, each.normal)});
    }
    for (std::size_t i = 0; i < truth_.curve().size(); ++i) add_on_curve(i, all);
    // Evenly from all of them, so that the whole region is covered.
    Contacts contacts;
    const std::size_t count = std::min(most, all.size());
    for (std::size_t i = 0; i < count; ++i) contacts.list.push_back(all[i * all.size() / count]);
    return contacts;
  }

 private:
  /// In the middle of a segment: of the normals of both triangles the one along which less is to be moved; both where
  /// that is the same. Normals at an acute angle leave the intersection at once, as in shallow contacts.
  void add_on_curve(std::size_t i, std::vector<Contact>& all) {
    const Segment& segment = truth_.curve()[i];
    const TrianglePair& pair = truth_.curve_triangles()[i];
    const Eigen::Vector3d middle = 0.5 * (segment.start + segment.end);
    const Eigen::Vector3d n_a = truth_.normal_of_a(pair), n_b = -truth_.normal_of_b(pair);
    if (n_a.isZero(0.0) || n_b.isZero(0.0)) return;  // of a triangle without area
    const double of_a = truth_.thickness(middle, n_a), of_b = truth_.thickness(middle, n_b);
    const double cosine = n_a.dot(n_b);
    const bool both_leave = cosine > k_right_angle;
    const bool is_flush = std::abs(cosine) <= k_right_angle || cosine < k_right_angle - 1.0;
    const double same = both_leave ? std::max(of_a, of_b) : k_contact_slack * truth_.diagonal();
    if (of_a <= of_b + same) add({middle, n_a, of_a}, is_flush, all);
    if (of_b <= of_a + same) add({middle, n_b, of_b}, is_flush, all);
  }

  /// Sides that lie in one plane cross by rounding, at edges where neither normal leads out.
  /// @param is_flush whether the triangles may belong to such sides
  void add(const Contact& contact, bool is_flush, std::vector<Contact>& all) {
    if (!is_flush || !truth_.judge(contact).is_reversed()) all.push_back(contact);
  }

  ContactTruth truth_;
};

}  // namespace

std::unique_ptr<Algorithm> make_exact_contacts_algorithm() {
  return make_algorithm<ExactContactsQuery>(
      {.name = "exact-contacts",
       .version = SIXDOF_VERSION,
       .summary = "contacts from exact geometry: vertices inside the other body, and where the surfaces cross",
       .answers = {.contacts = true},
       .depth = ContactDepth::local,
       .by_default = false});
}

}  // namespace sixdof
