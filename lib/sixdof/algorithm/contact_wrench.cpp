#include <sixdof/algorithm/contact_wrench.h>

#include <algorithm>
#include <utility>

namespace sixdof {
namespace {

constexpr const char* k_combine = "combine";

}  // namespace

ContactWrench::ContactWrench(const Settings& settings) {
  const std::string& combine = settings.choice(k_combine);
  combine_ = combine == "sum" ? Combine::sum : combine == "deepest" ? Combine::deepest : Combine::mean;
}

void ContactWrench::reset(const Eigen::Vector3d& reference) {
  count_ = 0;
  sum_ = {};
  sum_.reference = reference;
}

void ContactWrench::add(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double depth) {
  ++count_;
  // Not std::max(0, depth): a depth that is NaN must stay one.
  if (depth < 0.0) depth = 0.0;
  const Eigen::Vector3d force = depth * normal;
  const Eigen::Vector3d torque = (point - sum_.reference).cross(force);
  if (combine_ != Combine::deepest) {
    sum_.force += force;
    sum_.torque += torque;
  } else if (!(depth <= sum_.penalty)) {
    sum_.force = force;
    sum_.torque = torque;
  }
  sum_.penalty = std::max(sum_.penalty, depth);
}

Response ContactWrench::response() const {
  Response response = sum_;
  if (combine_ == Combine::mean && count_ > 0) {
    response.force /= static_cast<double>(count_);
    response.torque /= static_cast<double>(count_);
  }
  return response;
}

Parameter ContactWrench::combine_parameter() {
  return Parameter::choice(k_combine, "how depth * normal of all contacts become one force", "mean",
                           {"mean", "sum", "deepest"});
}

Parameter max_contacts_parameter(std::string default_value, double largest) {
  return Parameter::count("max_contacts", "a query with this many contacts fails, because the library drops the rest",
                          std::move(default_value), 1, largest);
}

}  // namespace sixdof
