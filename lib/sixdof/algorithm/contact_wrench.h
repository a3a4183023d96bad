#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <sixdof/query/algorithm.h>

/// The one rule by which contacts of a collision library become a response (ResponseLaw::contacts). Every algorithm
/// that gets contacts from a library uses it, so that their responses differ by the contacts only.
///
/// A contact pushes B by depth * normal at its point, its normal a unit vector that leads B out of A. The wrench is the
/// mean over the contacts, its penalty the largest depth. The mean, because the number of contacts depends on the
/// tessellation. A depth below 0 (the bodies are apart there, but within a margin of the library) counts as 0.

namespace sixdof {

class ContactWrench {
 public:
  /// @param settings has the parameter of combine_parameter()
  explicit ContactWrench(const Settings& settings);

  /// Forgets all contacts.
  /// @param reference of the torque, in A's frame
  void reset(const Eigen::Vector3d& reference);

  /// @param point in A's frame
  /// @param normal unit length, in A's frame, pointing from A to B
  /// @param depth of penetration along the normal (length)
  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double depth);

  std::size_t count() const { return count_; }

  /// The wrench of the contacts since reset(), zero if there are none. Its members are not finite where a contact's are
  /// not.
  Response response() const;

  /// How the contacts become one force: their mean, their sum, or the deepest one alone.
  static Parameter combine_parameter();

 private:
  enum class Combine {
    mean,
    sum,
    deepest
  };
  Combine combine_;
  std::size_t count_ = 0;
  Response sum_;
};

/// Number of contacts at which a query fails, for libraries that drop what exceeds it.
Parameter max_contacts_parameter(std::string default_value, double largest);

}  // namespace sixdof
