#include <sixdof/algorithm/fcl/contacts.h>

#include <fcl/config.h>

#include <algorithm>
#include <exception>
#include <string>

#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fmt/format.h>

#include <sixdof/algorithm/fcl/model.h>

namespace sixdof {
namespace {

using Model = fcl_backend::Model<fcl::OBBRSSd>;

constexpr const char* k_combine = "combine";
constexpr const char* k_max_contacts = "max_contacts";

enum class Combine {
  mean,
  sum,
  deepest
};

Combine combine_of(const std::string& choice) {
  return choice == "sum" ? Combine::sum : choice == "deepest" ? Combine::deepest : Combine::mean;
}

class ContactsQuery final : public Query {
 public:
  ContactsQuery(const Mesh& a, const Mesh& b, const Settings& settings)
      : a_(fcl_backend::build_model<fcl::OBBRSSd>(a)),
        b_(fcl_backend::build_model<fcl::OBBRSSd>(b)),
        center_b_(b.center()),
        combine_(combine_of(settings.choice(k_combine))) {
    request_.enable_contact = true;
    request_.num_max_contacts = static_cast<std::size_t>(settings.number(k_max_contacts));
  }

  Outcome<Response> respond(const Pose& X_AB) override {
    if (!is_finite(X_AB)) return fail(Status::failed, "the pose is not finite");
    fcl::Transform3d X = fcl::Transform3d::Identity();
    X.linear() = X_AB.R;
    X.translation() = X_AB.t;
    try {
      fcl::CollisionResultd result;
      fcl::collide<double>(a_.get(), fcl::Transform3d::Identity(), b_.get(), X, request_, result);
      if (result.numContacts() >= request_.num_max_contacts) {
        return fail(Status::failed, fmt::format("more contacts than {}", request_.num_max_contacts));
      }
      return combined(result, X_AB * center_b_);
    } catch (const std::exception& e) {
      return fail(Status::failed, e.what());
    }
  }

  Footprint footprint() const override {
    Footprint sum;
    for (const Model* model : {a_.get(), b_.get()}) sum.bytes += fcl_backend::bytes_of(*model);
    return sum;
  }

 private:
  Outcome<Response> combined(const fcl::CollisionResultd& result, const Eigen::Vector3d& reference) {
    Response response;
    response.reference = reference;
    double deepest = 0.0;
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
      const fcl::Contactd& contact = result.getContact(i);
      const double depth = std::max(0.0, contact.penetration_depth);
      // FCL's normal points from the first body to the second: A to B.
      const Eigen::Vector3d force = depth * contact.normal;
      const Eigen::Vector3d torque = (contact.pos - reference).cross(force);
      if (combine_ != Combine::deepest) {
        response.force += force;
        response.torque += torque;
      } else if (depth > deepest) {
        response.force = force;
        response.torque = torque;
      }
      deepest = std::max(deepest, depth);
    }
    if (combine_ == Combine::mean && result.numContacts() > 0) {
      response.force /= static_cast<double>(result.numContacts());
      response.torque /= static_cast<double>(result.numContacts());
    }
    response.penalty = deepest;
    if (!response.force.allFinite() || !response.torque.allFinite()) {
      return fail(Status::non_finite, "a contact is not finite");
    }
    return response;
  }

  const std::shared_ptr<const Model> a_;
  const std::shared_ptr<const Model> b_;
  const Eigen::Vector3d center_b_;
  const Combine combine_;
  fcl::CollisionRequestd request_;
};

}  // namespace

std::unique_ptr<Algorithm> make_fcl_contacts_algorithm() {
  return make_algorithm<ContactsQuery>(
      {.name = "fcl-contacts",
       .version = FCL_VERSION,
       .summary = "FCL's contacts of triangle pairs as a penalty wrench",
       .answers = {.respond = true},
       .law = ResponseLaw::depth,
       .parameters = {{.name = k_combine,
                       .meaning = "how depth * normal of all contacts become one force",
                       .unit = "",
                       .default_value = "mean",
                       .choices = {"mean", "sum", "deepest"}},
                      {.name = k_max_contacts,
                       .meaning = "a query with this many contacts fails, because FCL drops the rest",
                       .unit = "1",
                       .default_value = "1000000",
                       .low = 1,
                       .high = 1e9,
                       .integer = true}}});
}

}  // namespace sixdof
