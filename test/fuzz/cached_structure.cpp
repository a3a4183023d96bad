// Structures in the cache on disk. The first byte of an input picks one of the files that the preparation of `ist`,
// `ist-descent`, `vps` and `vps-field` leaves, the second what is done to it.
//
// 'd': the file is damaged (hdf5_edit.h). It counts as no entry, or has the arrays that were stored.
// 'f': the arrays are others, with a right hash, as another version of the program might store them. Whatever they
// hold, preparing and asking end, and an answer that is ok is finite.
#include <algorithm>
#include <cstring>

#include <sixdof/algorithm/ist/ist.h>
#include <sixdof/algorithm/vps/vps.h>
#include <sixdof/base/cache.h>
#include <sixdof/base/hdf5.h>
#include <sixdof/query/ask.h>

#include "hdf5_edit.h"
#include "small_meshes.h"

namespace sixdof::fuzz {
namespace {

/// What is prepared, coarse enough to be prepared anew for every input.
struct Subject {
  std::unique_ptr<Algorithm> algorithm;
  std::vector<std::pair<const char*, const char*>> settings;
};

const std::vector<Subject>& subjects() {
  static const auto* const all = [] {
    auto* list = new std::vector<Subject>;
    const std::vector<std::pair<const char*, const char*>> voxels{{"voxel_size", "0.1"}, {"point_spacing", "0.1"}};
    list->push_back({make_vps_field_algorithm(), voxels});
    list->push_back({make_vps_algorithm(), voxels});
    list->push_back({make_ist_algorithm(), {{"spheres", "12"}}});
    list->push_back({make_ist_descent_algorithm(), {{"spheres", "12"}}});
    return list;
  }();
  return *all;
}

const Mesh& mesh_a() {
  static const Mesh mesh = box();
  return mesh;
}
const Mesh& mesh_b() {
  static const Mesh mesh = tetrahedron();
  return mesh;
}

void prepare_and_ask(const Subject& subject) {
  Settings settings = subject.algorithm->settings();
  for (const auto& [name, value] : subject.settings) settings.set(name, value);
  const auto query = subject.algorithm->prepare(mesh_a(), mesh_b(), settings);
  Pose X_AB;
  X_AB.t = {0.3, 0.25, 0.2};
  Outcome<Response> answer = ask_guarded([&] { return query->respond(X_AB); }, [](const std::string&) {});
  examine(*query, answer, [](const std::string&) {});
  require(!answer.ok() || is_finite(answer.value), "an answer that is ok is finite");
}

/// A file of the cache and what it holds.
struct Stored {
  std::string kind, key, bytes;
  CacheEntry entry;
};

std::vector<Stored> fill_cache() {
  const auto folder = scratch_folder() / "cache";
  ::setenv("SIXDOF_CACHE", folder.c_str(), 1);
  for (const Subject& subject : subjects()) prepare_and_ask(subject);
  std::vector<Stored> list;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    Stored stored{.kind = name.substr(0, name.rfind('-')), .bytes = read_bytes(file.path())};
    {
      const hdf5::Session session;
      stored.key = hdf5::File::open(file.path()).read_string("/", "key");
    }
    require(cache_file(stored.kind, stored.key) == file.path(), "an entry lies where its key says");
    stored.entry = load_cached(stored.kind, stored.key).value();
    list.push_back(std::move(stored));
  }
  std::ranges::sort(list, {}, [](const Stored& s) { return s.kind + s.key; });
  return list;
}

void check_damage(const Stored& stored, Input& input) {
  damage_hdf5(cache_file(stored.kind, stored.key), input);
  const auto loaded = load_cached(stored.kind, stored.key);
  require(!loaded || loaded->arrays() == stored.entry.arrays(), "a damaged entry is none, or has what was stored");
}

template <class T>
void change_array(std::vector<T>& values, Input& input) {
  if (input.byte() % 4 == 0) values.resize(input.byte());
  for (int i = 0; i < 4 && !values.empty() && !input.empty(); ++i) {
    T& value = values[(input.byte() | std::size_t{input.byte()} << 8) % values.size()];
    const std::uint64_t bits = input.word();
    std::memcpy(&value, &bits, sizeof(T));
  }
}

void check_forgery(const Stored& stored, Input& input) {
  CacheEntry forged;
  for (const auto& array : stored.entry.arrays()) {
    const bool changed = input.byte() % 2 != 0;
    std::visit(
        [&](auto values) {
          if (changed) change_array(values, input);
          forged.put(array.first, std::move(values));
        },
        array.second);
  }
  require(store_cached(stored.kind, stored.key, forged), "the scratch folder has room");
  for (const Subject& subject : subjects()) {
    try {
      prepare_and_ask(subject);
    } catch (const Error&) {
      // Refused.
    }
  }
}

}  // namespace
}  // namespace sixdof::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sixdof::fuzz;
  static const std::vector<Stored> files = fill_cache();
  Input input(data, size);
  const Stored& stored = files[input.byte() % files.size()];
  input.byte() == 'f' ? check_forgery(stored, input) : check_damage(stored, input);
  write_bytes(sixdof::cache_file(stored.kind, stored.key), stored.bytes);
  return 0;
}
