#include <sixdof/geometry/load.h>

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>

#include <sixdof/base/error.h>
#include <sixdof/geometry/load_formats.h>

namespace sixdof {
namespace loading {

void Source::fail(const std::string& cause) const { throw BadFile(path.string(), cause); }

void Source::fail(const std::string& place, const std::string& cause) const {
  throw BadFile(path.string(), place, cause);
}

Source read_source(const std::filesystem::path& file) {
  Source source{file, {}};
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) source.fail("cannot be read: " + std::string(std::strerror(errno)));
  // A pipe or a device could keep us waiting forever.
  if (!S_ISREG(status.st_mode)) source.fail("cannot be read: not a regular file");
  std::ifstream in(file, std::ios::binary);
  if (!in) source.fail("cannot be read: " + std::string(std::strerror(errno)));
  source.bytes.resize(static_cast<std::size_t>(status.st_size));
  in.read(source.bytes.data(), static_cast<std::streamsize>(source.bytes.size()));
  if (static_cast<std::size_t>(in.gcount()) != source.bytes.size()) source.fail("cannot be read to its end");
  if (source.bytes.empty()) source.fail("is empty");
  return source;
}

namespace {

using Reader = Surface (*)(const Source&);

struct Format {
  const char* extension;
  Reader read;
};

constexpr Format k_formats[] = {
    {".ply", read_ply},   {".off", read_off},  {".obj", read_obj}, {".stl", read_stl},
    {".gltf", read_gltf}, {".glb", read_gltf}, {".3ds", read_3ds},
};

Reader reader_for(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  std::string known;
  for (const Format& format : k_formats) {
    if (extension == format.extension) return format.read;
    known += std::string(known.empty() ? "" : ", ") + format.extension;
  }
  throw BadFile(file.string(), "'" + extension + "' is no mesh format this can read (" + known + ")");
}

}  // namespace
}  // namespace loading

Mesh load_mesh(const std::filesystem::path& file) {
  try {
    const loading::Reader read = loading::reader_for(file);
    loading::Surface surface = read(loading::read_source(file));
    return Mesh::build(std::move(surface.vertices), std::move(surface.triangles), file.stem().string());
  } catch (const BadMesh& e) {
    throw BadFile(file.string(), e.what());
  } catch (const std::bad_alloc&) {
    throw BadFile(file.string(), "does not fit into memory");
  }
}

}  // namespace sixdof
