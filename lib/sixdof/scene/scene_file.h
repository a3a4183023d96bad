#pragma once

#include <filesystem>

#include <sixdof/scene/scene.h>

/// Scenes on disk, as HDF5; README.md has the format, which h5py reads and writes.
namespace sixdof::scene {

/// Writes a scene, whole or not at all. The same scene gives the same bytes.
/// @throws BadArgument as Scene::check() does, BadFile if the file cannot be written
void save_scene(const Scene& scene, const std::filesystem::path& file);

/// @throws BadFile naming the file and the place if it is no scene, is damaged, does not have the content hash that was
/// stored with it (a file without one is taken as it is), or is not what Scene::check() takes
Scene load_scene(const std::filesystem::path& file);

/// Whether the file is one that load_scene() takes, as far as its format attribute says. @throws BadFile if it cannot
/// be opened
bool is_scene(const std::filesystem::path& file);

}  // namespace sixdof::scene
