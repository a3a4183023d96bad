#include <sixdof/conformance/checks.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <sixdof/conformance/poses.h>
#include <sixdof/oracle/contact_truth.h>
#include <sixdof/query/ask.h>
#include <sixdof/query/contacts.h>

namespace sixdof::conformance {
namespace {

/// More than any library finds on the small meshes of the kit.
constexpr std::size_t k_all = 100'000;

/// Asks; a query without an answer is a failure. @return none then
std::optional<Contacts> contacts_of(Query& query, std::size_t most, const At& at, Findings& findings) {
  std::string words;
  const Outcome<Contacts> answer =
      ask_contacts(query, at.pose.X_AB, most, [&](const std::string& why) { words = why; });
  if (answer.ok()) return answer.value;
  findings.fail(fmt::format("no contacts, status {}: {}", to_string(answer.status), words), at);
  return std::nullopt;
}

/// Calls use(pair, case, query, place) for the cases at a place.
template <class Use>
void for_cases(const Subject& subject, Place place, const Use& use) {
  for (const Pair& pair : pairs(subject.traits().body)) {
    const auto query = subject.prepare(pair.a, pair.b);
    for (const Case& each : pair.cases) {
      if (each.place == place) use(pair, each, *query, At{subject, pair.a, pair.b, each.pose});
    }
  }
}

/// Some where bodies overlap, none where they are apart.
void check_contacts(const Subject& subject, Findings& findings) {
  const auto check = [&](Place place) {
    for_cases(subject, place, [&](const Pair&, const Case&, Query& query, const At& at) {
      const auto contacts = contacts_of(query, k_all, at, findings);
      if (!contacts || contacts->list.empty() == (place == Place::apart)) return;
      findings.fail(place == Place::apart ? fmt::format("{} contacts of bodies that are apart", contacts->list.size())
                                          : "no contact of bodies that overlap",
                    at);
    });
  };
  check(Place::overlapping);
  check(Place::apart);
}

/// As many as are asked for, if there are so many.
void check_at_most(const Subject& subject, Findings& findings) {
  for_cases(subject, Place::overlapping, [&](const Pair&, const Case&, Query& query, const At& at) {
    const auto all = contacts_of(query, k_all, at, findings);
    if (!all) return;
    for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{3}}) {
      const auto some = contacts_of(query, most, at, findings);
      if (!some || some->list.size() == std::min(most, all->list.size())) continue;
      findings.fail(
          fmt::format("{} contacts where {} are asked for and there are {}", some->list.size(), most, all->list.size()),
          at);
    }
  });
}

/// Calls use(contact, what exact geometry says, place) for the contacts of bodies that overlap.
template <class Use, class End>
void judge_all(const Subject& subject, Findings& findings, const Use& use, const End& at_end_of_pose) {
  for (const Pair& pair : pairs(subject.traits().body)) {
    const auto query = subject.prepare(pair.a, pair.b);
    ContactTruth truth(pair.a, pair.b);
    for (const Case& each : pair.cases) {
      if (each.place != Place::overlapping) continue;
      const At at{subject, pair.a, pair.b, each.pose};
      const auto contacts = contacts_of(*query, k_all, at, findings);
      if (!contacts || contacts->list.empty()) continue;
      truth.move_to(each.pose.X_AB);
      for (const Contact& contact : contacts->list) use(contact, truth.judge(contact));
      at_end_of_pose(at, static_cast<double>(contacts->list.size()));
    }
  }
}

/// Points lie in both bodies, or on them.
void check_points(const Subject& subject, Findings& findings) {
  const double claimed = subject.declared.contact_error;
  if (claimed == k_no_claim) return findings.has_no_claim("contact_error");
  double off = 0.0;
  judge_all(
      subject, findings, [&](const Contact&, const JudgedContact& judged) { off = std::max(off, judged.off()); },
      [&](const At& at, double) {
        if (off > claimed * at.a.diagonal()) {
          findings.fail(fmt::format("a contact is {} outside of one of the bodies; {:.3g} is allowed", off,
                                    claimed * at.a.diagonal()),
                        at);
        }
        off = 0.0;
      });
}

/// Normals lead from A to B, along normals of the surfaces.
void check_normals(const Subject& subject, Findings& findings) {
  const double claimed = subject.declared.contact_degrees;
  if (claimed == k_no_claim) return findings.has_no_claim("contact_degrees");
  double sum = 0.0;
  int reversed = 0;
  judge_all(
      subject, findings,
      [&](const Contact&, const JudgedContact& judged) {
        sum += judged.normal_angle;
        reversed += judged.is_reversed() ? 1 : 0;
      },
      [&](const At& at, double count) {
        if (sum > claimed * count || reversed > 0) {
          findings.fail(fmt::format("normals are {:.3g} degrees from true ones, {} of {:.0f} reversed; {} is claimed",
                                    sum / count, reversed, count, claimed),
                        at);
        }
        sum = 0.0;
        reversed = 0;
      });
}

/// Depths are the thickness of the intersection along the normals.
void check_depths(const Subject& subject, Findings& findings) {
  const double claimed = subject.declared.depth_error;
  if (claimed == k_no_claim) return findings.has_no_claim("depth_error");
  double depths = 0.0, thickness = 0.0;
  judge_all(
      subject, findings,
      [&](const Contact& contact, const JudgedContact& judged) {
        depths += contact.depth;
        thickness += judged.thickness;
      },
      [&](const At& at, double count) {
        const double slack = k_contact_slack * at.a.diagonal();  // of a thickness
        findings.expect_near("the sum of depths", depths, thickness, claimed * thickness + slack * count, at);
        depths = thickness = 0.0;
      });
}

/// Number and mean normal after a change.
/// @param there contacts(pair, case): in A's frame before the change
template <class There>
void expect_same(const Subject& subject, Findings& findings, const There& there) {
  const double claimed = subject.declared.contact_change_degrees;
  if (claimed == k_no_claim) return findings.has_no_claim("contact_change_degrees");
  for_cases(subject, Place::overlapping, [&](const Pair& pair, const Case& each, Query& query, const At& at) {
    const auto first = contacts_of(query, k_all, at, findings);
    const std::optional<Contacts> second = there(pair, each);
    if (!first || !second) return;
    const Eigen::Vector3d before = mean_normal(*first), after = mean_normal(*second);
    if (angle_between(before, after) <= claimed && before.isZero(0.0) == after.isZero(0.0)) return;
    findings.fail(fmt::format("{} contacts of mean normal {}, and {} of {} after the change", first->list.size(),
                              text_of(before), second->list.size(), text_of(after)),
                  at);
  });
}

void check_order(const Subject& subject, Findings& findings) {
  expect_same(subject, findings, [&](const Pair& pair, const Case& each) -> std::optional<Contacts> {
    const Pose& X_AB = each.pose.X_AB;
    const auto query = subject.prepare(pair.b, pair.a);
    const TypedPose back = TypedPose::of(X_AB.inverse());
    const auto found = contacts_of(*query, k_all, {subject, pair.b, pair.a, back}, findings);
    return found ? std::optional(exchanged(*found, X_AB)) : std::nullopt;
  });
}

void check_motion(const Subject& subject, Findings& findings) {
  const Pose X = generic_motion(8);
  expect_same(subject, findings, [&](const Pair& pair, const Case& each) -> std::optional<Contacts> {
    const Mesh a = moved(pair.a, X), b = moved(pair.b, X);
    const auto query = subject.prepare(a, b);
    const TypedPose there = TypedPose::of(X * each.pose.X_AB * X.inverse());
    const auto found = contacts_of(*query, k_all, {subject, a, b, there}, findings);
    return found ? std::optional(sixdof::moved(*found, X.inverse())) : std::nullopt;
  });
}

void check_not_finite(const Subject& subject, Findings& findings) {
  const Pair& pair = pairs(subject.traits().body).front();
  const auto query = subject.prepare(pair.a, pair.b);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Pose X_AB = pair.cases.front().pose.X_AB;
    X_AB.t.y() = bad;
    const Status status = ask_contacts(*query, X_AB, k_all, [](const std::string&) {}).status;
    if (status == Status::failed || status == Status::non_finite) continue;
    findings.fail(fmt::format("contacts at a pose that is not finite: status {}; it should be failed or non_finite",
                              to_string(status)));
  }
}

constexpr Check k_checks[] = {
    {"Contacts", Needs::contacts, check_contacts},       {"ContactsAtMost", Needs::contacts, check_at_most},
    {"ContactPoints", Needs::contacts, check_points},    {"ContactNormals", Needs::contacts, check_normals},
    {"ContactDepths", Needs::contacts, check_depths},    {"OrderOfContacts", Needs::contacts, check_order},
    {"MotionOfContacts", Needs::contacts, check_motion}, {"ContactsNotFinite", Needs::contacts, check_not_finite}};

}  // namespace

std::span<const Check> contact_checks() { return k_checks; }

}  // namespace sixdof::conformance
