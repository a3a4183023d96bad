#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <sixdof/query/algorithm.h>
#include <sixdof/query/settings.h>
#include <sixdof/geometry/mesh.h>
#include <sixdof/geometry/pose.h>

namespace sixdof {

/// What an ideal wrench follows. README.md of this room derives each for each scenario.
enum class IdealLaw {
  depth,     ///< Magnitude = translational penetration depth p, in the direction the paper states.
  volume,    ///< Magnitude = intersection volume V, in the direction the paper states.
  gradient,  ///< Wrench = -grad V: the energy is V (rigid plastic contact). At a kink of V all along a path (the plate
             ///< of III and IV on its block): on the side where the bodies separate.
  energy,    ///< Wrench = -V grad V: the energy is V^2 / 2 (elastic contact).
  traction,  ///< Integral, over B's surface inside A, of depth below A's surface along B's inward normals (as VPS).
  wall_traction,  ///< The same along the outward normals of A's nearest wall.
  paper_depth,    ///< The paper's printed formula for p, literally.
  paper_volume,   ///< The paper's printed formula for V, literally.
};

/// "depth", "volume", "gradient", "energy", "traction", "wall-traction", "paper-depth", "paper-volume".
std::string_view to_string(IdealLaw law);

/// The words above; "paper" is the literal formula of the law that the algorithm declares, and "own" is that law
/// itself.
/// @throws BadArgument for another word, or if "paper" or "own" meets an algorithm without a law.
IdealLaw parse_ideal_law(std::string_view word, ResponseLaw own);

/// All laws in the order of the enumeration.
std::vector<IdealLaw> all_ideal_laws();

/// What the ideal model says at one progress. Magnitudes are those of the formula, without a stiffness.
struct IdealWrench {
  double penalty = 0.0;                              ///< p (length) or V (length^3), whatever the law is about.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< On B, in A's frame.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< On B about the scenario's reference point, in A's frame.
};

/// A length shown in a drawing.
struct Dimension {
  Eigen::Vector2d from;  ///< In the x, y plane of A's frame.
  Eigen::Vector2d to;
  Eigen::Vector2d offset;  ///< From the measured points to the dimension line.
  std::string label;
};

/// How a scenario wants to be drawn (drawing.h).
struct Sketch {
  double progress = 0.0;     ///< Where B is shown.
  Eigen::AlignedBox2d part;  ///< Part of the x, y plane that the plan shows.
  Eigen::Vector3d up;        ///< What is up in the oblique view.
  bool underside = false;    ///< The plan shows B's faces that look down, as through glass.
  std::vector<Dimension> dimensions;
};

/// Two solids, a path of B, and what a response should be along it.
class Scenario {
 public:
  /// What is fixed about a scenario beside its solids.
  struct About {
    std::string name;
    std::string purpose;
    std::vector<std::string> rules;
    Eigen::Vector3d reference_b = Eigen::Vector3d::Zero();
    double reference_length = 1.0;
    bool closed = false;
  };

  virtual ~Scenario() = default;
  Scenario(const Scenario&) = delete;
  Scenario& operator=(const Scenario&) = delete;

  const std::string& name() const { return about_.name; }                 ///< "Ia", "Ib", "II", "III", "IV".
  const std::string& purpose() const { return about_.purpose; }           ///< What it tells about an algorithm.
  const std::vector<std::string>& rules() const { return about_.rules; }  ///< What a fair run has to honour.

  const Mesh& a() const { return a_; }  ///< Fixed. Its mesh frame is the frame of all answers.
  const Mesh& b() const { return b_; }  ///< Moving.

  /// Point that torques are about, in B's frame.
  const Eigen::Vector3d& reference_b() const { return about_.reference_b; }

  /// Length that makes torque over force a pure number, in the meshes' unit.
  double reference_length() const { return about_.reference_length; }

  /// The path ends where it starts.
  bool closed() const { return about_.closed; }

  /// Progress of each of `count` time stamps, increasing within [0, 1]. An open path has stamps on both ends, k/(N-1).
  /// A closed one is cut into N equal parts with a stamp in the middle of each, (k + 1/2)/N: no pose counts twice, and
  /// none of the poses where a flat wall is exactly touched is hit if N is a multiple of four. @throws BadArgument for
  /// fewer than 2.
  std::vector<double> stamps(std::size_t count) const;

  /// X_AB at `progress` in [0, 1].
  virtual Pose pose(double progress) const = 0;

  /// Where the ideal's direction is the one the paper states: measures without suffix are taken there.
  virtual bool in_window(double /*progress*/) const { return true; }

  /// Empty if the law says nothing here (the paper prints no formula). Each law is there for all progress or for none.
  virtual std::optional<IdealWrench> ideal(IdealLaw law, double progress) const = 0;

  virtual Sketch sketch() const = 0;

 protected:
  Scenario(About about, Mesh a, Mesh b) : about_(std::move(about)), a_(std::move(a)), b_(std::move(b)) {}

 private:
  About about_;
  Mesh a_;
  Mesh b_;
};

/// "Ia", "Ib", "II", "III", "IV".
const std::vector<std::string>& scenario_names();

/// Every length, angle and tessellation of a scenario with the paper's default. @throws BadArgument for another name.
Settings scenario_settings(std::string_view name);

/// @throws BadArgument if the lengths contradict each other (a cone wider than its block, pins that overlap).
std::unique_ptr<Scenario> make_scenario(std::string_view name, const Settings& settings);

/// With all defaults.
std::unique_ptr<Scenario> make_scenario(std::string_view name);

}  // namespace sixdof
