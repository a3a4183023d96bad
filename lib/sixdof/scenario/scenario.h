#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>
#include <sixdof/query/algorithm.h>
#include <sixdof/query/settings.h>

/// A response scenario: two solids, a path of the moving one (B), and the ideal response along the path. Progress runs
/// over the path from 0 to 1; a recording visits it in steps.

namespace sixdof {

/// The law that an ideal wrench obeys. README.md of this folder derives each law for each scenario.
enum class IdealLaw {
  depth,     ///< Magnitude = translational penetration depth p, in the direction the paper states.
  volume,    ///< Magnitude = intersection volume V, in the direction the paper states.
  gradient,  ///< Wrench = -grad V: the energy is V (rigid plastic contact). Where V has a kink all along the path (the
             ///< plate of III and IV on its block), the one-sided gradient on the side where the bodies separate.
  energy,    ///< Wrench = -V grad V: the energy is V^2 / 2 (elastic contact).
  traction,  ///< Integral, over B's surface inside A, of depth below A's surface along B's inward normals (as VPS).
  wall_traction,  ///< The same along the outward normals of A's nearest face.
  normals,        ///< Integral over the intersection of (n_A - n_B) / 2, n the outward normal where the surface of A
                  ///< or B is nearest (as inner spheres with normal cones).
  descent,        ///< Magnitude = V, in the direction of -grad V among all motions of B; rotations are measured in the
                  ///< intersection's radius of gyration (as `ist-descent`).
  paper_depth,    ///< The paper's formula for p, as printed.
  paper_volume,   ///< The paper's formula for V, as printed.
};

/// "depth", "volume", "gradient", "energy", "traction", "wall-traction", "normals", "descent",
/// "paper-depth", "paper-volume".
std::string_view to_string(IdealLaw law);

/// The law that the algorithm's wrench tends to with increasing resolution (README.md, "Which law is whose"): for those
/// of this project whose limit is known that law, for all others the law of magnitude that they declare.
/// @throws BadArgument if there is none
IdealLaw own_law(const Traits& traits);

/// The words above; "own" is own_law(), "paper" the formula, as printed, of the magnitude that the algorithm declares.
/// @throws BadArgument for another word, or for "paper" or "own" if the algorithm declares no law
IdealLaw parse_ideal_law(std::string_view word, const Traits& traits);

/// All laws in the order of the enumeration.
std::vector<IdealLaw> all_ideal_laws();

/// The ideal response at one progress. Magnitudes are those of the formula, without a stiffness.
struct IdealWrench {
  double penalty = 0.0;                              ///< p (length) or V (length^3), by the law.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< On B, in A's frame.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< On B about the scenario's reference point, in A's frame.
};

/// One scenario; immutable.
class Scenario {
 public:
  /// The constants of a scenario besides its solids.
  struct Description {
    std::string name;                                       ///< "Ia", "Ib", "II", "III", "IV".
    std::string purpose;                                    ///< The question it answers.
    std::vector<std::string> rules;                         ///< Conditions of a fair run.
    Eigen::Vector3d reference_b = Eigen::Vector3d::Zero();  ///< Point that torques are about, in B's frame.
    double reference_length = 1.0;  ///< Makes torque over force a pure number, in the meshes' unit.
    bool closed = false;            ///< The path ends where it starts.
  };

  virtual ~Scenario() = default;  ///< Of whatever derives from it.
  Scenario(const Scenario&) = delete;
  Scenario& operator=(const Scenario&) = delete;

  /// Its constants.
  const Description& description() const { return description_; }
  /// Description::name.
  const std::string& name() const { return description_.name; }

  const Mesh& a() const { return a_; }  ///< Fixed. Its mesh frame is the frame of all answers.
  const Mesh& b() const { return b_; }  ///< Moving.

  /// Progress of each of `count` steps, increasing within [0, 1]. An open path has steps at both ends, k / (N - 1).
  /// A closed path has them at (k + 1/2) / N: no pose counts twice, and if N is a multiple of four, no step falls on a
  /// pose where a flat wall exactly touches. @throws BadArgument for fewer than 2
  std::vector<double> steps(std::size_t count) const;

  /// X_AB at `progress` in [0, 1].
  virtual Pose pose(double progress) const = 0;

  /// Whether the ideal's direction at `progress` is the one the paper states: measures without suffix use these steps.
  virtual bool in_window(double /*progress*/) const { return true; }

  /// Empty if the law has no ideal here (the paper prints no formula). Each law has one for all progress or for none.
  virtual std::optional<IdealWrench> ideal(IdealLaw law, double progress) const = 0;

 protected:
  /// Of both solids, A fixed and B moving.
  Scenario(Description description, Mesh a, Mesh b)
      : description_(std::move(description)), a_(std::move(a)), b_(std::move(b)) {}

 private:
  Description description_;
  Mesh a_;
  Mesh b_;
};

/// "Ia", "Ib", "II", "III", "IV".
std::vector<std::string> scenario_names();

/// Every length, angle and tessellation of a scenario with the paper's default. @throws BadArgument for another name
Settings scenario_settings(std::string_view name);

/// The scenario of a name.
/// @throws BadArgument if the lengths contradict each other (a cone wider than its block, pins that overlap)
std::unique_ptr<Scenario> make_scenario(std::string_view name, const Settings& settings);

/// With all defaults.
std::unique_ptr<Scenario> make_scenario(std::string_view name);

}  // namespace sixdof
