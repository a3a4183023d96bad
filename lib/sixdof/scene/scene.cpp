#include <sixdof/scene/scene.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <unordered_map>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>

namespace sixdof::scene {
namespace {

void check_pose(const RecordedPose& pose, const std::string& place) {
  try {
    if (!std::ranges::all_of(pose.numbers, [](double x) { return std::isfinite(x); })) {
      throw BadArgument("a number is not finite");
    }
    pose.pose();
  } catch (const BadArgument& e) {
    throw BadArgument(fmt::format("{}: {}", place, e.what()));
  }
}

void check_bodies(const Scene& scene) {
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.mesh >= scene.meshes.size()) {
      throw BadArgument(fmt::format("body {}: mesh {} of {}", i, body.mesh, scene.meshes.size()));
    }
    check_pose(body.pose, fmt::format("body {}", i));
    ids.push_back(body.id);
  }
  std::ranges::sort(ids);
  if (const auto twice = std::ranges::adjacent_find(ids); twice != ids.end()) {
    throw BadArgument(fmt::format("two bodies have the identifier {}", *twice));
  }
  for (const BodyPair& pair : scene.ignored) {
    if (pair.a >= pair.b) throw BadArgument(fmt::format("ignored pair {} {}: not in order", pair.a, pair.b));
    for (const std::uint32_t id : {pair.a, pair.b}) {
      if (!std::ranges::binary_search(ids, id)) throw BadArgument(fmt::format("ignored pair: no body {}", id));
    }
  }
  if (std::ranges::adjacent_find(scene.ignored, std::greater_equal<>()) != scene.ignored.end()) {
    throw BadArgument("the ignored pairs are not sorted, or one comes twice");
  }
}

void check_frames(const Scene& scene) {
  if (scene.frames.empty() || !scene.frames.front().empty()) throw BadArgument("the first frame must move nothing");
  std::vector<std::size_t> last(scene.bodies.size(), 0);
  for (std::size_t f = 1; f < scene.frames.size(); ++f) {
    for (const Motion& motion : scene.frames[f]) {
      if (motion.body >= scene.bodies.size()) {
        throw BadArgument(fmt::format("frame {}: body number {} of {}", f, motion.body, scene.bodies.size()));
      }
      const Body& body = scene.bodies[motion.body];
      if (body.fixed) throw BadArgument(fmt::format("frame {}: body {} is fixed and moves", f, body.id));
      if (std::exchange(last[motion.body], f) == f) {
        throw BadArgument(fmt::format("frame {}: body {} moves twice", f, body.id));
      }
      check_pose(motion.pose, fmt::format("frame {}, body {}", f, body.id));
    }
  }
}

void check_deformations(const Scene& scene) {
  if (scene.deformations.empty()) return;
  if (scene.deformations.size() != scene.frames.size()) {
    throw BadArgument(
        fmt::format("deformations of {} frames in a scene of {}", scene.deformations.size(), scene.frames.size()));
  }
  if (!scene.deformations.front().empty()) throw BadArgument("the first frame must deform nothing");
  if (scene.shapes() == 0) throw BadArgument("deformations are given, but no mesh deforms");
  for (std::size_t f = 1; f < scene.deformations.size(); ++f) {
    std::size_t next = 0;  // meshes below are done
    for (const Deformation& deformation : scene.deformations[f]) {
      const std::string place = fmt::format("frame {}, mesh {}", f, deformation.mesh);
      if (deformation.mesh >= scene.meshes.size()) {
        throw BadArgument(fmt::format("{}: the scene has {} meshes", place, scene.meshes.size()));
      }
      if (deformation.mesh < next) throw BadArgument(place + ": not in the order of meshes, or twice");
      next = deformation.mesh + std::size_t{1};
      if (!deformation.vertices) throw BadArgument(place + ": the vertices are missing");
      try {
        static_cast<void>(scene.meshes[deformation.mesh]->with_vertices(*deformation.vertices));
      } catch (const BadMesh& e) {
        throw BadArgument(fmt::format("{}: {}", place, e.what()));
      }
    }
  }
  for (const Body& body : scene.bodies) {
    if (body.fixed && scene.deforms(body.mesh)) {
      throw BadArgument(fmt::format("body {} is fixed, but its mesh {} deforms", body.id, body.mesh));
    }
  }
}

}  // namespace

RecordedPose RecordedPose::of(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  const Eigen::Vector4d q = Pose{R, t}.quaternion();
  return {{q[0], q[1], q[2], q[3], t.x(), t.y(), t.z()}};
}

Pose RecordedPose::pose() const {
  return Pose::from_quaternion(numbers[0], numbers[1], numbers[2], numbers[3], {numbers[4], numbers[5], numbers[6]});
}

void Scene::check() const {
  if (!(margin >= 0.0) || !std::isfinite(margin)) throw BadArgument(fmt::format("margin {}", margin));
  if (bodies.size() < 2) throw BadArgument(fmt::format("a scene of {} bodies; it needs two", bodies.size()));
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (!meshes[i]) throw BadArgument(fmt::format("mesh {} is missing", i));
  }
  check_bodies(*this);
  check_frames(*this);
  check_deformations(*this);
}

bool Scene::deforms(std::uint32_t mesh) const {
  return std::ranges::any_of(deformations, [&](const std::vector<Deformation>& frame) {
    return std::ranges::find(frame, mesh, &Deformation::mesh) != frame.end();
  });
}

std::string Scene::hash() const {
  ContentHash hash;
  const auto add = [&hash](const auto& value) { hash.add_values(std::span(&value, 1)); };
  const auto add_count = [&add](std::size_t n) { add(static_cast<std::uint64_t>(n)); };
  add(margin);
  add_count(meshes.size());
  for (const auto& mesh : meshes) hash.add_values(std::span(std::string_view(mesh->hash())));
  add_count(bodies.size());
  for (const Body& body : bodies) {
    add(body.id);
    add(body.mesh);
    add(static_cast<std::uint32_t>(body.fixed));
    add(body.pose.numbers);
  }
  add_count(ignored.size());
  for (const BodyPair& pair : ignored) {
    add(pair.a);
    add(pair.b);
  }
  add_count(frames.size());
  for (const Frame& frame : frames) {
    add_count(frame.size());
    for (const Motion& motion : frame) {
      add(motion.body);
      add(motion.pose.numbers);
    }
  }
  for (const std::vector<Deformation>& frame : deformations) {
    add_count(frame.size());
    for (const Deformation& deformation : frame) {
      add(deformation.mesh);
      hash.add(std::as_bytes(std::span(*deformation.vertices)));
    }
  }
  return hash.hex();
}

std::size_t Scene::triangles() const {
  std::size_t sum = 0;
  for (const Body& body : bodies) sum += meshes[body.mesh]->triangles().size();
  return sum;
}

std::size_t Scene::motions() const {
  std::size_t sum = 0;
  for (const Frame& frame : frames) sum += frame.size();
  return sum;
}

std::size_t Scene::shapes() const {
  std::size_t sum = 0;
  for (const std::vector<Deformation>& frame : deformations) sum += frame.size();
  return sum;
}

PairFilter::PairFilter(const Scene& scene) : ignored_(scene.ignored) {
  std::uint64_t fixed = 0;
  std::unordered_map<std::uint32_t, std::size_t> index;
  for (const Body& body : scene.bodies) {
    index[body.id] = ids_.size();
    ids_.push_back(body.id);
    fixed_.push_back(body.fixed);
    fixed += body.fixed ? 1 : 0;
  }
  has_ignored_.assign(ids_.size(), false);
  const auto pairs_of = [](std::uint64_t n) { return n == 0 ? 0 : n * (n - 1) / 2; };
  pairs_ = pairs_of(ids_.size()) - pairs_of(fixed);
  for (const BodyPair& pair : ignored_) {
    const std::size_t a = index.at(pair.a), b = index.at(pair.b);
    has_ignored_[a] = true;
    has_ignored_[b] = true;
    if (!(fixed_[a] && fixed_[b])) --pairs_;
  }
}

bool PairFilter::matters(std::uint32_t i, std::uint32_t j) const {
  if (fixed_[i] && fixed_[j]) return false;
  if (!has_ignored_[i] || !has_ignored_[j]) return true;
  return !std::ranges::binary_search(ignored_, BodyPair::of(ids_[i], ids_[j]));
}

Scene shuffled(const Scene& scene, std::uint64_t seed) {
  std::vector<std::uint32_t> order(scene.bodies.size());
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937_64 random(seed);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  Scene result = scene;
  std::vector<std::uint32_t> place(order.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    result.bodies[k] = scene.bodies[order[k]];
    place[order[k]] = k;
  }
  for (Frame& frame : result.frames) {
    for (Motion& motion : frame) motion.body = place[motion.body];
    std::ranges::sort(frame, {}, &Motion::body);
  }
  return result;
}

Scene excerpt(const Scene& scene, std::span<const std::uint32_t> ids, std::size_t first, std::size_t last) {
  if (first > last || last >= scene.frames.size()) {
    throw BadArgument(fmt::format("frames {} to {}: the scene has 0 to {}", first, last, scene.frames.size() - 1));
  }
  for (const std::uint32_t id : ids) {
    if (std::ranges::find(scene.bodies, id, &Body::id) == scene.bodies.end()) {
      throw BadArgument(fmt::format("the scene has no body {}", id));
    }
  }
  const auto is_kept = [&](std::uint32_t id) { return ids.empty() || std::ranges::find(ids, id) != ids.end(); };
  Scene result = scene;
  std::map<std::uint32_t, const std::vector<Eigen::Vector3d>*> shapes;  // vertices of a mesh in frame `first`
  for (std::size_t f = 1; f <= first; ++f) {
    for (const Motion& motion : scene.frames[f]) result.bodies[motion.body].pose = motion.pose;
    if (!scene.deforms()) continue;
    for (const Deformation& deformation : scene.deformations[f]) shapes[deformation.mesh] = deformation.vertices.get();
  }
  for (const auto& [mesh, vertices] : shapes) {
    result.meshes[mesh] = std::make_shared<const Mesh>(scene.meshes[mesh]->with_vertices(*vertices));
  }
  std::unordered_map<std::uint32_t, std::uint32_t> place;  // of what is kept, by its index before
  for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
    if (is_kept(scene.bodies[i].id)) place.emplace(i, static_cast<std::uint32_t>(place.size()));
  }
  std::erase_if(result.bodies, [&](const Body& body) { return !is_kept(body.id); });
  std::erase_if(result.ignored, [&](const BodyPair& pair) { return !is_kept(pair.a) || !is_kept(pair.b); });
  result.frames.assign(1, {});
  for (std::size_t f = first + 1; f <= last; ++f) {
    Frame& frame = result.frames.emplace_back();
    for (const Motion& motion : scene.frames[f]) {
      if (const auto at = place.find(motion.body); at != place.end()) frame.push_back({at->second, motion.pose});
    }
  }
  if (!scene.deforms()) return result;
  result.deformations.assign(1, {});
  for (std::size_t f = first + 1; f <= last; ++f) result.deformations.push_back(scene.deformations[f]);
  if (result.shapes() == 0) result.deformations.clear();
  return result;
}

std::vector<Moved> start_of(const Scene& scene) {
  std::vector<Moved> moved;
  moved.reserve(scene.bodies.size());
  for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) moved.push_back({i, scene.bodies[i].pose.pose()});
  return moved;
}

std::vector<Moved> moves_of(const Frame& frame) {
  std::vector<Moved> moved;
  moved.reserve(frame.size());
  for (const Motion& motion : frame) moved.push_back({motion.body, motion.pose.pose()});
  return moved;
}

std::vector<Deformed> shapes_of(const Scene& scene, std::size_t frame) {
  std::vector<Deformed> shapes;
  if (!scene.deforms()) return shapes;
  for (const Deformation& deformation : scene.deformations[frame]) {
    shapes.push_back({deformation.mesh, *deformation.vertices});
  }
  return shapes;
}

}  // namespace sixdof::scene
