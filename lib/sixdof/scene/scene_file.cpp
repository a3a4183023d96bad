#include <sixdof/scene/scene_file.h>

#include <algorithm>
#include <span>
#include <string>

#include <fmt/format.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include <sixdof/base/hdf5.h>

namespace sixdof::scene {
namespace {

constexpr const char* k_format = "sixdof-scene";
constexpr std::uint64_t k_version = 1;
constexpr std::uint64_t k_version_with_vertices = 2;  // of a scene in which a mesh deforms
constexpr std::size_t k_numbers = 7;                  // of a pose

std::string mesh_group(std::size_t index) { return fmt::format("/meshes/{}", index); }

void write_mesh(hdf5::File& file, const std::string& group, const Mesh& mesh) {
  file.make_group(group);
  file.write_attribute(group, "name", mesh.name());
  file.write_matrix(group + "/vertices", mesh.vertices().front().data(), mesh.vertices().size(), 3, 0);
  const std::span<const std::uint32_t> corners(mesh.triangles().front().data(), 3 * mesh.triangles().size());
  file.write_values(group + "/triangles", corners);
}

void write_poses(hdf5::File& file, const std::string& object, const std::vector<RecordedPose>& poses) {
  const RecordedPose none;
  const double* const numbers = poses.empty() ? none.numbers.data() : poses.front().numbers.data();
  file.write_values(object, std::span<const double>(numbers, k_numbers * poses.size()));
}

void write_bodies(hdf5::File& file, const Scene& scene) {
  std::vector<std::uint32_t> ids, meshes, fixed, ignored;
  std::vector<RecordedPose> poses;
  for (const Body& body : scene.bodies) {
    ids.push_back(body.id);
    meshes.push_back(body.mesh);
    fixed.push_back(body.fixed ? 1 : 0);
    poses.push_back(body.pose);
  }
  for (const BodyPair& pair : scene.ignored) {
    ignored.push_back(pair.a);
    ignored.push_back(pair.b);
  }
  file.make_group("/bodies");
  file.write_values<std::uint32_t>("/bodies/id", ids);
  file.write_values<std::uint32_t>("/bodies/mesh", meshes);
  file.write_values<std::uint32_t>("/bodies/fixed", fixed);
  write_poses(file, "/bodies/pose", poses);
  if (!ignored.empty()) file.write_values<std::uint32_t>("/ignored_pairs", ignored);
}

void write_frames(hdf5::File& file, const Scene& scene) {
  std::vector<std::uint64_t> start{0};
  std::vector<std::uint32_t> ids;
  std::vector<RecordedPose> poses;
  for (const Frame& frame : scene.frames) {
    for (const Motion& motion : frame) {
      ids.push_back(scene.bodies[motion.body].id);
      poses.push_back(motion.pose);
    }
    start.push_back(ids.size());
  }
  file.make_group("/frames");
  file.write_values<std::uint64_t>("/frames/start", start);
  if (ids.empty()) return;
  file.write_values<std::uint32_t>("/frames/id", ids);
  write_poses(file, "/frames/pose", poses);
}

void write_deformations(hdf5::File& file, const Scene& scene) {
  if (!scene.deforms()) return;
  std::vector<std::uint64_t> start{0};
  std::vector<std::uint32_t> meshes;
  std::vector<double> numbers;
  for (const std::vector<Deformation>& frame : scene.deformations) {
    for (const Deformation& deformation : frame) {
      meshes.push_back(deformation.mesh);
      for (const Eigen::Vector3d& p : *deformation.vertices) numbers.insert(numbers.end(), p.data(), p.data() + 3);
    }
    start.push_back(meshes.size());
  }
  file.write_values<std::uint64_t>("/frames/deformed_start", start);
  file.write_values<std::uint32_t>("/frames/deformed_mesh", meshes);
  file.write_matrix("/frames/vertices", numbers.data(), numbers.size() / 3, 3, 0);
}

/// Reads what write_...() wrote.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path.string()), file_(hdf5::File::open(path)) {
    if (!file_.has_attribute("/", "format") || file_.read_string("/", "format") != k_format) {
      refuse("root", "is not a sixdof scene");
    }
    const auto version = file_.read_attribute<std::uint64_t>("/", "format_version");
    if (version != k_version && version != k_version_with_vertices) {
      refuse("root", fmt::format("has format version {}, but this build reads versions {} and {}", version, k_version,
                                 k_version_with_vertices));
    }
    has_vertices_ = version == k_version_with_vertices;
  }

  Scene read() {
    Scene scene;
    scene.name = text("name");
    scene.recipe = text("recipe");
    scene.margin = file_.read_attribute<double>("/", "margin");
    for (std::size_t i = 0; file_.exists(mesh_group(i)); ++i) scene.meshes.push_back(read_mesh(mesh_group(i)));
    const std::size_t groups = file_.names("/meshes").size();
    if (groups != scene.meshes.size()) {
      refuse("/meshes", fmt::format("{} groups that are not named 0, 1, 2, ...", groups - scene.meshes.size()));
    }
    read_bodies(scene);
    read_frames(scene);
    if (has_vertices_) read_deformations(scene);
    try {
      scene.check();
    } catch (const BadArgument& e) {
      throw BadFile(path_, e.what());
    }
    if (file_.has_attribute("/", "content_hash") && file_.read_string("/", "content_hash") != scene.hash()) {
      refuse("root", "content does not have the hash that was stored with it: damaged or edited");
    }
    return scene;
  }

 private:
  [[noreturn]] void refuse(const std::string& object, const std::string& cause) const {
    throw BadFile(path_, object, cause);
  }

  std::string text(const char* name) const {
    return file_.has_attribute("/", name) ? file_.read_string("/", name) : std::string();
  }

  std::shared_ptr<const Mesh> read_mesh(const std::string& group) const {
    const auto [rows, columns] = file_.matrix_size(group + "/vertices");
    if (columns != 3) refuse(group + "/vertices", fmt::format("is {} x {}, not n x 3", rows, columns));
    const std::vector<double> numbers = file_.read_matrix(group + "/vertices");
    const auto corners = file_.read_values<std::uint32_t>(group + "/triangles");
    if (corners.size() % 3 != 0) refuse(group + "/triangles", "is not three numbers for each triangle");
    std::vector<Eigen::Vector3d> vertices(rows);
    for (std::size_t i = 0; i < rows; ++i) vertices[i] = Eigen::Vector3d(&numbers[3 * i]);
    std::vector<Triangle> triangles(corners.size() / 3);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      triangles[i] = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
    }
    const std::string name = file_.has_attribute(group, "name") ? file_.read_string(group, "name") : group;
    try {
      return std::make_shared<const Mesh>(Mesh::build(std::move(vertices), std::move(triangles), name));
    } catch (const BadMesh& e) {
      refuse(group, e.what());
    }
  }

  template <class T>
  std::vector<T> values(const std::string& object, std::size_t count) const {
    std::vector<T> found = file_.read_values<T>(object);
    if (found.size() != count) refuse(object, fmt::format("has {} numbers, not {}", found.size(), count));
    return found;
  }

  std::vector<RecordedPose> poses(const std::string& object, std::size_t count) const {
    const std::vector<double> numbers = values<double>(object, k_numbers * count);
    std::vector<RecordedPose> found(count);
    for (std::size_t i = 0; i < count; ++i) std::copy_n(&numbers[k_numbers * i], k_numbers, found[i].numbers.begin());
    return found;
  }

  void read_bodies(Scene& scene) const {
    const auto ids = file_.read_values<std::uint32_t>("/bodies/id");
    const auto meshes = values<std::uint32_t>("/bodies/mesh", ids.size());
    const auto fixed = file_.exists("/bodies/fixed") ? values<std::uint32_t>("/bodies/fixed", ids.size())
                                                     : std::vector<std::uint32_t>(ids.size(), 0);
    const std::vector<RecordedPose> start = poses("/bodies/pose", ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (fixed[i] > 1) refuse("/bodies/fixed", fmt::format("number {} is {}, not 0 or 1", i, fixed[i]));
      scene.bodies.push_back({ids[i], meshes[i], fixed[i] != 0, start[i]});
    }
    if (!file_.exists("/ignored_pairs")) return;
    const auto ignored = file_.read_values<std::uint32_t>("/ignored_pairs");
    if (ignored.size() % 2 != 0) refuse("/ignored_pairs", "is not two identifiers for each pair");
    for (std::size_t i = 0; i < ignored.size(); i += 2) scene.ignored.push_back({ignored[i], ignored[i + 1]});
  }

  void read_frames(Scene& scene) const {
    const auto start = file_.read_values<std::uint64_t>("/frames/start");
    if (start.size() < 2 || start.front() != 0 || !std::ranges::is_sorted(start)) {
      refuse("/frames/start", "does not rise from 0");
    }
    const std::size_t count = start.back() == 0 ? 0 : file_.read_values<std::uint32_t>("/frames/id").size();
    if (count != start.back()) {
      refuse("/frames/id", fmt::format("has {} identifiers; /frames/start ends with {}", count, start.back()));
    }
    std::vector<std::uint32_t> ids;
    std::vector<RecordedPose> moves;
    if (count > 0) {
      ids = file_.read_values<std::uint32_t>("/frames/id");
      moves = poses("/frames/pose", count);
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> index;
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) index.emplace_back(scene.bodies[i].id, i);
    std::ranges::sort(index);
    for (std::size_t f = 0; f + 1 < start.size(); ++f) {
      Frame& frame = scene.frames.emplace_back();
      for (std::size_t k = start[f]; k < start[f + 1]; ++k) {
        const auto found = std::ranges::lower_bound(index, std::pair(ids[k], 0u));
        if (found == index.end() || found->first != ids[k]) {
          refuse("/frames/id", fmt::format("number {} is {}, which no body has", k, ids[k]));
        }
        frame.push_back({found->second, moves[k]});
      }
    }
  }

  void read_deformations(Scene& scene) const {
    const auto start = file_.read_values<std::uint64_t>("/frames/deformed_start");
    if (start.size() != scene.frames.size() + 1 || start.front() != 0 || !std::ranges::is_sorted(start)) {
      refuse("/frames/deformed_start", "does not rise from 0, or is not one longer than there are frames");
    }
    const auto meshes = values<std::uint32_t>("/frames/deformed_mesh", start.back());
    const auto [rows, columns] = file_.matrix_size("/frames/vertices");
    if (columns != 3) refuse("/frames/vertices", fmt::format("is {} x {}, not n x 3", rows, columns));
    std::size_t needed = 0;
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      if (meshes[k] >= scene.meshes.size()) {
        refuse("/frames/deformed_mesh", fmt::format("number {} is {} of {}", k, meshes[k], scene.meshes.size()));
      }
      needed += scene.meshes[meshes[k]]->vertices().size();
    }
    if (rows != needed) {
      refuse("/frames/vertices",
             fmt::format("has {} rows; the meshes of /frames/deformed_mesh have {} vertices", rows, needed));
    }
    const std::vector<double> numbers = file_.read_matrix("/frames/vertices");
    std::size_t next = 0;
    for (std::size_t f = 0; f + 1 < start.size(); ++f) {
      std::vector<Deformation>& frame = scene.deformations.emplace_back();
      for (std::size_t k = start[f]; k < start[f + 1]; ++k) {
        std::vector<Eigen::Vector3d> vertices(scene.meshes[meshes[k]]->vertices().size());
        for (Eigen::Vector3d& p : vertices) p = Eigen::Vector3d(&numbers[3 * next++]);
        frame.push_back({meshes[k], std::make_shared<const std::vector<Eigen::Vector3d>>(std::move(vertices))});
      }
    }
  }

  std::string path_;
  hdf5::File file_;
  bool has_vertices_ = false;
};

}  // namespace

void save_scene(const Scene& scene, const std::filesystem::path& path) {
  scene.check();
  AtomicFile atomic(path);
  const hdf5::Session session;
  {
    hdf5::File file = hdf5::File::create(atomic);
    file.write_attribute("/", "format", std::string(k_format));
    file.write_attribute("/", "format_version", scene.deforms() ? k_version_with_vertices : k_version);
    file.write_attribute("/", "name", scene.name);
    file.write_attribute("/", "recipe", scene.recipe);
    file.write_attribute("/", "margin", scene.margin);
    file.make_group("/meshes");
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) write_mesh(file, mesh_group(i), *scene.meshes[i]);
    write_bodies(file, scene);
    write_frames(file, scene);
    write_deformations(file, scene);
    file.write_attribute("/", "content_hash", scene.hash());
    file.close();
  }
  atomic.commit();
}

Scene load_scene(const std::filesystem::path& path) {
  const hdf5::Session session;
  return Reader(path).read();
}

bool is_scene(const std::filesystem::path& path) {
  const hdf5::Session session;
  const hdf5::File file = hdf5::File::open(path);
  return file.has_attribute("/", "format") && file.read_string("/", "format") == k_format;
}

}  // namespace sixdof::scene
