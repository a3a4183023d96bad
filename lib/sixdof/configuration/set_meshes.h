#pragma once

#include <filesystem>
#include <string>

#include <sixdof/configuration/configuration_set.h>
#include <sixdof/geometry/mesh.h>

/// The meshes of a set: what the set says of where they are, and how they are found again. The content hash decides,
/// not the name: a file that has changed is refused, a file that has moved is found where it may be.

namespace sixdof {

/// The identity of a mesh that load_model(name_or_file) gave. That of a file says where the file is.
MeshIdentity identify(const Mesh& mesh, const std::string& name_or_file);

/// Finds a mesh again. A mesh with a path is looked for in this order, until one has the content hash:
/// 1. the path as the user wrote it, relative to the working directory;
/// 2. the same relative to the set's folder;
/// 3. the absolute path;
/// 4. a file of that name in the set's folder; the model of the catalogue that is called as the mesh.
/// A mesh without a path is that model.
/// @param wanted with name, hash and paths; an empty hash takes any mesh
/// @param set the file of the set; messages name it
/// @param instead where the mesh is, a model's name or a file, if the caller knows better; nothing else is tried then
/// @return the mesh; its name is the set's
/// @throws BadFile naming a file whose mesh has another hash, with both hashes, or the places where nothing is;
/// BadArgument for an unknown model; what load_model() throws
Mesh find_mesh(const MeshIdentity& wanted, const std::filesystem::path& set, const std::string& instead = {});

}  // namespace sixdof
