// Adapters around `exact`, each wrong in one way. conformance_test.cpp says which checks each must fail.

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include <Eigen/Geometry>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/conformance/conformance.h>
#include <sixdof/conformance/declared.h>

namespace sixdof {
namespace {

using conformance::Meaning;

/// What a fault may look at.
struct Asked {
  const Mesh &a, &b;
  const Pose& X_AB;
  Query& exact;
  const Settings& settings;  ///< Those that prepare() was given: gone by now, if the caller wants.
  int calls = 0;             ///< Queries of this object, this one included.
  int number = 0;            ///< Objects of all adapters that were prepared, this one included.
  std::thread::id thread;    ///< That prepared the first object.

  bool solids() const { return a.solid() && b.solid(); }
  bool surfaces_meet() const { return exact.distance(X_AB).value.distance == 0.0; }
  bool swapped() const { return a.name() == "cone-100" && b.name() == "torus-300"; }
  bool has(const char* word) const { return a.name().find(word) != std::string::npos; }
  bool is_finite() const { return X_AB.R.allFinite() && X_AB.t.allFinite(); }
};

/// Changes the right answer to a wrong one.
struct Fault {
  std::function<void(const Asked&, Outcome<bool>&)> collide;
  std::function<void(const Asked&, Outcome<Separation>&)> distance;
  std::function<void(const Asked&, Outcome<Response>&)> respond;
  std::function<void(const Motion&, Outcome<Impact>&)> cast;
  std::function<void(const Asked&, Outcome<Contacts>&)> contacts;
};

class WrongQuery final : public Query {
 public:
  WrongQuery(const Mesh& a, const Mesh& b, const Settings& settings, const Fault& fault)
      : a_(a), b_(b), settings_(settings), fault_(fault), algorithm_(make_exact_algorithm()) {
    exact_ = algorithm_->prepare(a, b, algorithm_->settings());
    if (fault_.contacts) contacts_ = exact_contacts_->prepare(a, b, exact_contacts_->settings());
    static std::atomic<int> prepared = 0;
    number_ = ++prepared;
  }

  Outcome<bool> collide(const Pose& X_AB) override { return answer(&Query::collide, fault_.collide, X_AB); }
  Outcome<Separation> distance(const Pose& X_AB) override { return answer(&Query::distance, fault_.distance, X_AB); }
  Outcome<Response> respond(const Pose& X_AB) override { return answer(&Query::respond, fault_.respond, X_AB); }

  Outcome<Impact> cast(const Motion& motion) override {
    if (!fault_.cast) return Status::unsupported;
    Outcome<Impact> outcome = exact_->cast(motion);
    fault_.cast(motion, outcome);
    return outcome.ok() ? outcome : Outcome<Impact>(fail(outcome.status, exact_->diagnosis()));
  }

  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override {
    if (!contacts_) return Status::unsupported;
    Outcome<Contacts> outcome = contacts_->contacts(X_AB, most);
    fault_.contacts({a_, b_, X_AB, *exact_, settings_, calls_, number_, {}}, outcome);
    return outcome.ok() ? outcome : Outcome<Contacts>(fail(outcome.status, contacts_->diagnosis()));
  }

 private:
  template <class T, class Change>
  Outcome<T> answer(Outcome<T> (Query::*question)(const Pose&), const Change& change, const Pose& X_AB) {
    if (fault_.cast || fault_.contacts) return Status::unsupported;  // adapters of these answer nothing else
    Outcome<T> outcome = ((*exact_).*question)(X_AB);
    ++calls_;
    static const std::thread::id first = std::this_thread::get_id();
    if (change) change({a_, b_, X_AB, *exact_, settings_, calls_, number_, first}, outcome);
    return outcome.ok() ? outcome : Outcome<T>(fail(outcome.status, exact_->diagnosis()));
  }

  const Mesh &a_, &b_;
  const Settings& settings_;
  const Fault& fault_;
  std::unique_ptr<Algorithm> algorithm_;
  std::unique_ptr<Query> exact_;
  const std::unique_ptr<Algorithm> exact_contacts_ = make_exact_contacts_algorithm();
  std::unique_ptr<Query> contacts_;
  int calls_ = 0, number_ = 0;
};

class WrongAlgorithm final : public Algorithm {
 public:
  WrongAlgorithm(Traits traits, Fault fault) : traits_(std::move(traits)), fault_(std::move(fault)) {}
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings& settings) const override {
    return std::make_unique<WrongQuery>(a, b, settings, fault_);
  }

 private:
  const Traits traits_;
  const Fault fault_;
};

constexpr QuerySet k_all{.collide = true, .distance = true, .respond = true};

conformance::Source wrong(const char* name, Fault fault, QuerySet answers = k_all, const char* summary = "wrong") {
  return conformance::Source([=] {
    return std::make_unique<WrongAlgorithm>(
        Traits{.name = name,
               .version = "1",
               .summary = summary,
               .answers = answers,
               .law = answers.respond ? ResponseLaw::volume : ResponseLaw::none,
               .parameters = {Parameter::choice("mode", "read by one of them", "on", {"on"})}},
        fault);
  });
}

conformance::Source wrong_cast(const char* name, std::function<void(const Motion&, Outcome<Impact>&)> change) {
  return wrong(name, {.cast = std::move(change)}, {.cast = true});
}

conformance::Source wrong_contacts(const char* name, std::function<void(const Asked&, Outcome<Contacts>&)> change) {
  return wrong(name, {.contacts = std::move(change)}, {.contacts = true});
}

/// Changes each contact.
conformance::Source wrong_contact(const char* name, std::function<void(const Asked&, Contact&)> change) {
  return wrong_contacts(name, [=](const Asked& asked, Outcome<Contacts>& outcome) {
    for (Contact& each : outcome.value.list) change(asked, each);
  });
}

/// Turns normals by a degree where the fault is.
conformance::Source wrong_normals(const char* name, std::function<bool(const Asked&)> where) {
  return wrong_contact(name, [=](const Asked& asked, Contact& contact) {
    const Eigen::AngleAxisd turn(0.017, Eigen::Vector3d(0.48, 0.6, -0.64));
    if (where(asked)) contact.normal = turn * contact.normal;
  });
}

conformance::Source wrong_collide(const char* name, std::function<bool(const Asked&)> where) {
  return wrong(name, {.collide = [=](const Asked& asked, Outcome<bool>& outcome) {
                 if (where(asked)) outcome.value = !outcome.value;
               }});
}

/// Distances that are too large by a fraction of both diagonals, and no witnesses.
conformance::Source wrong_distance(const char* name, std::function<double(const Asked&)> fraction) {
  return wrong(name, {.distance = [=](const Asked& asked, Outcome<Separation>& outcome) {
                 outcome.value.distance += fraction(asked) * (asked.a.diagonal() + asked.b.diagonal());
                 outcome.value.has_witnesses = false;
               }});
}

/// Forces that are too large by a thousandth.
conformance::Source wrong_respond(const char* name, std::function<bool(const Asked&)> where) {
  return wrong(name, {.respond = [=](const Asked& asked, Outcome<Response>& outcome) {
                 if (where(asked)) outcome.value.force *= 1.001;
               }});
}

/// 10 times the error that a declaration allows by default.
constexpr double k_too_much = 1e-11;

conformance::Declaration bodies() { return {.collide = Meaning::bodies}; }

/// Of contacts that are right.
conformance::Declaration right_contacts() { return conformance::declaration_of("exact-contacts"); }

// clang-format off
SIXDOF_CONFORMANCE(wrong("right", {}), bodies());
SIXDOF_CONFORMANCE(wrong("wrong-declaration", {}, k_all, ""), bodies());
SIXDOF_CONFORMANCE(wrong_collide("wrong-collide", [](const Asked& q) { return q.solids() && q.surfaces_meet(); }), bodies());
SIXDOF_CONFORMANCE(wrong_collide("wrong-collide-of-contained", [](const Asked& q) { return q.solids() && !q.surfaces_meet() && q.exact.collide(q.X_AB).value; }), bodies());
SIXDOF_CONFORMANCE(wrong_distance("wrong-distance", [](const Asked& q) { return q.solids() ? k_too_much : 0.0; }), bodies());
SIXDOF_CONFORMANCE(wrong("wrong-witnesses", {.distance = [](const Asked& q, Outcome<Separation>& outcome) { outcome.value.witness_b = q.X_AB.inverse() * outcome.value.witness_b; }}), bodies());
SIXDOF_CONFORMANCE(wrong("wrong-respond", {.respond = [](const Asked&, Outcome<Response>& outcome) { outcome.value.force *= -1.0; outcome.value.torque *= -1.0; }}), bodies());
SIXDOF_CONFORMANCE(wrong("wrong-volume", {.respond = [](const Asked&, Outcome<Response>& outcome) { outcome.value.volume *= 1.001; }}), bodies());
SIXDOF_CONFORMANCE(wrong("wrong-open-surfaces", {}), {.collide = Meaning::bodies, .open_meshes = false});
SIXDOF_CONFORMANCE(wrong_collide("wrong-order-of-collide", &Asked::swapped), bodies());
SIXDOF_CONFORMANCE(wrong_distance("wrong-order-of-distance", [](const Asked& q) { return q.swapped() ? k_too_much : 0.0; }), bodies());
SIXDOF_CONFORMANCE(wrong_respond("wrong-order-of-respond", &Asked::swapped), bodies());
SIXDOF_CONFORMANCE(wrong_collide("wrong-motion-of-collide", [](const Asked& q) { return q.has("(moved)"); }), bodies());
SIXDOF_CONFORMANCE(wrong_distance("wrong-motion-of-distance", [](const Asked& q) { return q.has("(moved)") ? k_too_much : 0.0; }), bodies());
SIXDOF_CONFORMANCE(wrong_respond("wrong-motion-of-respond", [](const Asked& q) { return q.has("(moved)"); }), bodies());
SIXDOF_CONFORMANCE(wrong_collide("wrong-scale-of-collide", [](const Asked& q) { return q.has("(scaled)"); }), bodies());
SIXDOF_CONFORMANCE(wrong_distance("wrong-scale-of-distance", [](const Asked& q) { return q.has("(scaled)") ? k_too_much : 0.0; }), bodies());
SIXDOF_CONFORMANCE(wrong_respond("wrong-scale-of-respond", [](const Asked& q) { return q.has("(scaled)"); }), bodies());
SIXDOF_CONFORMANCE(wrong_cast("right-cast", [](const Motion&, Outcome<Impact>&) {}), bodies());
SIXDOF_CONFORMANCE(wrong_cast("wrong-cast", [](const Motion&, Outcome<Impact>& outcome) { if (outcome.value.t > 0.0) outcome.value.t *= 0.999; }), bodies());
SIXDOF_CONFORMANCE(wrong_cast("wrong-cast-at-start", [](const Motion&, Outcome<Impact>& outcome) { if (outcome.value.at_start()) outcome.value.t = 0.5; }), bodies());
SIXDOF_CONFORMANCE(wrong_cast("wrong-cast-without-motion", [](const Motion& motion, Outcome<Impact>& outcome) { if (motion.length(1.0) == 0.0) outcome.value = {.hit = true, .t = 1.0}; }), bodies());
SIXDOF_CONFORMANCE(wrong_cast("wrong-motions-not-finite", [](const Motion&, Outcome<Impact>& outcome) { if (!outcome.ok()) outcome = Impact{}; }), bodies());
SIXDOF_CONFORMANCE(wrong_contacts("right-contacts", [](const Asked&, Outcome<Contacts>&) {}), right_contacts());
SIXDOF_CONFORMANCE(wrong_contacts("wrong-contacts", [](const Asked&, Outcome<Contacts>& outcome) { outcome.value.list.clear(); }), right_contacts());
SIXDOF_CONFORMANCE(wrong_contacts("wrong-contacts-at-most", [](const Asked&, Outcome<Contacts>& outcome) { const auto copy = outcome.value.list; outcome.value.list.insert(outcome.value.list.end(), copy.begin(), copy.end()); }), right_contacts());
SIXDOF_CONFORMANCE(wrong_contact("wrong-contact-points", [](const Asked& q, Contact& contact) { contact.point = q.X_AB.inverse() * contact.point; }), right_contacts());
SIXDOF_CONFORMANCE(wrong_contact("wrong-contact-normals", [](const Asked&, Contact& contact) { contact.normal *= -1.0; }), right_contacts());
SIXDOF_CONFORMANCE(wrong_contact("wrong-contact-depths", [](const Asked&, Contact& contact) { contact.depth *= 0.5; }), right_contacts());
SIXDOF_CONFORMANCE(wrong_normals("wrong-order-of-contacts", &Asked::swapped), right_contacts());
SIXDOF_CONFORMANCE(wrong_normals("wrong-motion-of-contacts", [](const Asked& q) { return q.has("(moved)"); }), right_contacts());
SIXDOF_CONFORMANCE(wrong_contacts("wrong-contacts-not-finite", [](const Asked&, Outcome<Contacts>& outcome) { if (!outcome.ok()) outcome = Contacts{}; }), right_contacts());
SIXDOF_CONFORMANCE(wrong("wrong-poses-not-finite", {.collide = [](const Asked& q, Outcome<bool>& outcome) { if (!q.is_finite()) outcome = false; }}), bodies());
SIXDOF_CONFORMANCE(wrong("wrong-unsupported", {}, {.collide = true, .distance = true}), bodies());
SIXDOF_CONFORMANCE(wrong_distance("wrong-repeated-queries", [](const Asked& q) { return q.calls * 1e-15; }), bodies());
SIXDOF_CONFORMANCE(wrong_distance("wrong-fresh-queries", [](const Asked& q) { return (q.number % 7) * 1e-14; }), bodies());
SIXDOF_CONFORMANCE(wrong_collide("wrong-threads", [](const Asked& q) { return std::this_thread::get_id() != q.thread; }), bodies());
SIXDOF_CONFORMANCE(wrong_collide("wrong-same-mesh", [](const Asked& q) { return &q.a == &q.b; }), bodies());
SIXDOF_CONFORMANCE(wrong_collide("wrong-moved-settings", [](const Asked& q) { return q.settings.choice("mode") != "on"; }), bodies());

// Known failures: one that is there, one that is not, one of no check; and algorithms that cannot be had.
SIXDOF_CONFORMANCE(wrong_collide("known-failure", [](const Asked& q) { return q.has("(moved)"); }), {.collide = Meaning::bodies, .known_failures = {{"MotionOfCollide", "moved meshes", "upstream#1"}}});
SIXDOF_CONFORMANCE(wrong("known-but-passes", {}), {.collide = Meaning::bodies, .known_failures = {{"Distance", "long gone", ""}}});
SIXDOF_CONFORMANCE(wrong("known-of-no-check", {}), {.collide = Meaning::bodies, .known_failures = {{"Distanc", "a slip", ""}}});
SIXDOF_CONFORMANCE("no-registrar");
SIXDOF_CONFORMANCE(wrong("no-such-setting", {}), {.settings = {"speed=9"}});
// clang-format on

}  // namespace
}  // namespace sixdof
