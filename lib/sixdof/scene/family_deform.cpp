#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include <sixdof/models/recipe.h>
#include <sixdof/oracle/distance.h>
#include <sixdof/scene/family_parts.h>

// One mesh that deforms, and rigid bodies beside it which it comes close to, touches and leaves. Maps of space that
// move points along one direction by a function of the others (shears) have an inverse, so a surface moved by them
// meets itself only where its triangles are coarse. The motion grows smoothly from rest; no vertex is ever displaced by
// more than the amplitude times the diagonal of the mesh's box.

namespace sixdof::scene::detail {
namespace {

using Eigen::Vector3d;
using Vertices = std::vector<Vector3d>;
/// The place of a vertex at a time from 0 to 1, given where it is at rest.
using Motion3d = std::function<Vector3d(const Vector3d& rest, double time)>;

constexpr double k_amplitude = 0.03;
constexpr double k_margin = 0.02;  // in diagonals of the mesh that deforms
constexpr std::size_t k_triangles = 20'000, k_partner_triangles = 2'000;
constexpr double k_two_pi = 2.0 * std::numbers::pi;

/// From 0 to 1 with slopes 0.
double ease(double time) { return time * time * (3.0 - 2.0 * time); }

/// From -1 to 1 and back over a period of 1, in straight lines; 0 at 0.
double zigzag(double x) {
  const double phase = x + 0.25 - std::floor(x + 0.25);
  return phase < 0.5 ? 4.0 * phase - 1.0 : 3.0 - 4.0 * phase;
}

/// Any direction at a right angle to a unit vector.
Vector3d across(const Vector3d& direction, Random& random) {
  for (;;) {
    const Vector3d other = random.direction();
    const Vector3d rest = other - other.dot(direction) * direction;
    if (const double n = rest.norm(); n > 0.3) return rest / n;
  }
}

std::size_t triangles_of(const SceneNumbers& numbers) {
  return numbers.triangles == 0 ? k_triangles : numbers.triangles;
}

/// Largest displacement of a mesh (length).
double reach_of(const SceneNumbers& numbers, const Mesh& mesh) {
  return own(numbers.amplitude, k_amplitude) * mesh.diagonal();
}

/// A scene in which the first body deforms.
class Stage {
 public:
  Stage(const SceneNumbers& numbers, Mesh mesh) : numbers_(numbers), size_(mesh.diagonal()), mover_(scene_) {
    scene_.margin = own(numbers.margin, k_margin) * size_;
    scene_.frames.resize(1);
    scene_.meshes.push_back(std::make_shared<const Mesh>(std::move(mesh)));
    mover_.add(0, Eigen::Matrix3d::Identity(), Vector3d::Zero());
  }

  const Mesh& mesh() const { return *scene_.meshes.front(); }

  /// A rigid body of its own shape.
  void add(Mesh mesh, const Eigen::Matrix3d& R, const Vector3d& center, bool fixed = false) {
    scene_.meshes.push_back(std::make_shared<const Mesh>(std::move(mesh)));
    mover_.add(static_cast<std::uint32_t>(scene_.meshes.size() - 1), R, center, fixed);
  }

  /// A bumpy ball that came from far along u towards the origin until it touched the mesh at rest, and was then moved
  /// back by a gap (length; negative: it overlaps).
  void add_ball(double radius, const Vector3d& u, double gap, Random& random) {
    constexpr int k_most_steps = 200;
    Mesh ball = make_bumpy_sphere({.radius = radius}, k_partner_triangles);
    const Eigen::Matrix3d R = random.rotation();
    const DistanceOracle oracle(mesh(), ball);
    DistanceQuery query(oracle);
    double along = size_ + 2.0 * radius;
    for (int step = 0; step < k_most_steps; ++step) {
      const double left = query.distance({R, along * u}).distance;
      if (left < 1e-6 * size_) break;
      along -= left;
    }
    add(std::move(ball), R, (along + gap) * u);
  }

  /// Balls in random directions, at gaps from -1/2 of the amplitude to all of it.
  void add_balls(std::size_t count, double radius, Random& random) {
    const double reach = reach_of(numbers_, mesh());
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3d u = random.direction();
      add_ball(radius, u, reach * (1.5 * static_cast<double>(i) / static_cast<double>(count) - 0.5), random);
    }
  }

  /// Records the frames: the mesh by its motion, the other bodies as they drift and turn a little.
  Scene play(const Motion3d& motion, Random& random) {
    const double step = own(numbers_.step, 0.002) * size_;
    const Vertices& rest = mesh().vertices();
    for (std::size_t f = 1; f < numbers_.frames; ++f) {
      const double time = static_cast<double>(f) / static_cast<double>(numbers_.frames - 1);
      auto moved = std::make_shared<Vertices>(rest.size());
      for (std::size_t i = 0; i < rest.size(); ++i) (*moved)[i] = motion(rest[i], time);
      scene_.frames.emplace_back();
      scene_.deformations.resize(f);
      scene_.deformations.push_back({{0, std::move(moved)}});
      for (std::uint32_t body = 1; body < scene_.bodies.size(); ++body) {
        if (scene_.bodies[body].fixed || random.unit() >= own(numbers_.moving, 1.0)) continue;
        const Pose& pose = mover_.poses[body];
        const Eigen::Matrix3d R = random.small_rotation(k_degree) * pose.R;
        const Vector3d t = pose.t + random.in_cube(step);
        mover_.move(body, R, t);
      }
    }
    return std::move(scene_);
  }

 private:
  SceneNumbers numbers_;
  double size_;
  Scene scene_;
  Mover mover_;
};

constexpr std::size_t k_partners = 4;

}  // namespace

Scene make_wave(const SceneNumbers& numbers) {
  Random random(numbers.seed);
  Stage stage(numbers, make_sphere({}, triangles_of(numbers)));
  const double reach = reach_of(numbers, stage.mesh());
  const Vector3d up = random.direction();
  struct Wave {
    Vector3d along;
    double per_length, start, share;
  };
  std::array<Wave, 3> waves;
  for (std::size_t k = 0; k < waves.size(); ++k) {
    waves[k] = {across(up, random), 0.5 + static_cast<double>(k), random.unit(), k == 0 ? 0.5 : 0.25};
  }
  stage.add_balls(k_partners, 0.3, random);
  return stage.play(
      [=](const Vector3d& p, double time) -> Vector3d {
        double height = 0.0;
        for (const Wave& wave : waves) {
          height += wave.share * std::sin(k_two_pi * (wave.per_length * wave.along.dot(p) + wave.start - 2.0 * time));
        }
        return p + reach * ease(time) * height * up;
      },
      random);
}

Scene make_twist(const SceneNumbers& numbers) {
  constexpr double k_length = 4.0, k_width = 0.8, k_share_of_twist = 0.3;
  Random random(numbers.seed);
  Stage stage(numbers, make_box({.size = {k_length, k_width, k_width}}, triangles_of(numbers)));
  const double reach = reach_of(numbers, stage.mesh());
  // A corner at the end travels along an arc of its share of the amplitude; the bend moves the ends by the rest.
  const double angle = k_share_of_twist * reach / (0.5 * k_width * std::numbers::sqrt2);
  const double bend = (1.0 - k_share_of_twist) * reach;
  stage.add_balls(k_partners, 0.3, random);
  return stage.play(
      [=](const Vector3d& p, double time) -> Vector3d {
        const double x = p.x() / (0.5 * k_length), turn = angle * x * ease(time);
        const double c = std::cos(turn), s = std::sin(turn);
        return {p.x(), c * p.y() - s * p.z(), s * p.y() + c * p.z() + bend * x * x * ease(time)};
      },
      random);
}

Scene make_bump(const SceneNumbers& numbers) {
  constexpr double k_width = 0.25;
  Random random(numbers.seed);
  Stage stage(numbers, make_sphere({}, triangles_of(numbers)));
  const double reach = reach_of(numbers, stage.mesh());
  const Vector3d top = random.direction();
  constexpr double k_radius = 0.4;
  // The bump meets a ball above it when it has grown half of its height.
  stage.add_ball(k_radius, top, 0.5 * reach, random);
  stage.add_balls(k_partners - 1, k_radius, random);
  return stage.play(
      [=](const Vector3d& p, double time) -> Vector3d {
        return p + reach * ease(time) * std::exp(-(p - top).squaredNorm() / (2.0 * k_width * k_width)) * top;
      },
      random);
}

Scene make_crumple(const SceneNumbers& numbers) {
  constexpr std::size_t k_folds = 8;
  Random random(numbers.seed);
  Stage stage(numbers, make_sphere({}, triangles_of(numbers)));
  const double reach = reach_of(numbers, stage.mesh()) / static_cast<double>(k_folds);
  struct Fold {
    Vector3d up, along;
    double per_length, start;
  };
  std::array<Fold, k_folds> folds;
  for (std::size_t k = 0; k < k_folds; ++k) {
    const Vector3d up = random.direction();
    folds[k] = {up, across(up, random), 0.4 + 0.4 * static_cast<double>(k), random.unit()};
  }
  stage.add_balls(k_partners, 0.3, random);
  return stage.play(
      [=](const Vector3d& rest, double time) -> Vector3d {
        Vector3d p = rest;
        for (const Fold& fold : folds) {
          p += reach * ease(time) * zigzag(fold.per_length * fold.along.dot(p) + fold.start + 0.5 * time) * fold.up;
        }
        return p;
      },
      random);
}

Scene make_cloth(const SceneNumbers& numbers) {
  constexpr double k_edge = 2.4, k_ball = 0.6, k_start = 0.01, k_end = -0.002;
  Random random(numbers.seed);
  const auto cells =
      static_cast<std::uint32_t>(std::max(2.0, std::sqrt(0.5 * static_cast<double>(triangles_of(numbers)))));
  Vertices vertices;
  std::vector<Triangle> triangles;
  for (std::uint32_t j = 0; j <= cells; ++j) {
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = k_edge * (i / static_cast<double>(cells) - 0.5),
                   y = k_edge * (j / static_cast<double>(cells) - 0.5);
      vertices.emplace_back(x, y, 0.0);
      if (i == cells || j == cells) continue;
      const std::uint32_t a = j * (cells + 1) + i, b = a + cells + 1;
      triangles.push_back({a, a + 1, b + 1});
      triangles.push_back({a, b + 1, b});
    }
  }
  Stage stage(numbers, Mesh::build(std::move(vertices), std::move(triangles), "cloth"));
  const double size = stage.mesh().diagonal(), reach = reach_of(numbers, stage.mesh());
  // The cloth at rest lies on the ball's top but for k_start of its size; it falls by the amplitude where nothing is
  // below, and stays outside a ball of this size until the end, when it sinks in by a little.
  stage.add(make_sphere({.radius = k_ball}, k_partner_triangles), random.rotation(),
            {0.0, 0.0, -k_ball - k_start * size}, true);
  stage.add_balls(k_partners - 1, 0.2, random);
  const double ripples = 0.05 * reach, start = random.unit();
  return stage.play(
      [=](const Vector3d& p, double time) -> Vector3d {
        const double r = std::hypot(p.x(), p.y()), clearance = size * (k_start + (k_end - k_start) * ease(time));
        // Height of the ball under the cloth; the sheet hangs from where a line of slope 1 touches it.
        const double rim = k_ball / std::numbers::sqrt2;
        const double ball = r < rim ? std::sqrt(k_ball * k_ball - r * r) - k_ball : rim - k_ball - (r - rim);
        const double resting = ball + clearance - k_start * size;
        const double ripple = ripples * std::sin(k_two_pi * (3.0 * std::atan2(p.y(), p.x()) / k_two_pi + start)) *
                              std::min(1.0, r / rim) * ease(time);
        const double fallen = -(reach - ripples) * ease(time);
        return {p.x(), p.y(), std::clamp(std::max(fallen, resting) + ripple, -reach, reach)};
      },
      random);
}

}  // namespace sixdof::scene::detail
