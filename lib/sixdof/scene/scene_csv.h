#pragma once

#include <filesystem>

#include <sixdof/scene/scene.h>

namespace sixdof::scene {

/// A scene of meshes and a table of poses. The first line of the table names its columns, in any order:
///
///     frame,body,mesh,tx,ty,tz,qw,qx,qy,qz,ignored
///     0,1,hull.stl,0,0,0,1,0,0,0,
///     0,2,part.obj,1.5,0,0,1,0,0,0,1 3
///     0,3,torus-10k,3,0,0,1,0,0,0,
///     1,2,,1.4,0,0,1,0,0,0,
///
/// A row is a body's pose X_WB from that frame on: translation (length) and unit quaternion. Frames are numbered from 0
/// and do not decrease; a body that has no row in a frame stays where it is. `body` is its identifier. Every body has a
/// row in frame 0, with its mesh: the name of a file in the folder, or of a model (models/model_catalogue.h); later
/// rows may leave the mesh out. Where a later row names another file or model, of the same triangles, the body's mesh
/// has the vertices of that one from this frame on: it deforms, and with it all bodies of the mesh. Two columns are
/// optional, and count in frame 0: `fixed` is 1 for a body that never moves; `ignored` has the identifiers of bodies
/// whose pair with this one does not matter, separated by blanks, as those of neighbouring links of a robot. CsvText
/// has the rules of the text.
///
/// @param folder of mesh files
/// @param margin of the query for near pairs (length)
/// @throws BadFile "FILE: line N: CAUSE" or "FILE: line N, column C: CAUSE" for a table that is wrong, and as
/// load_mesh() does; "FILE: CAUSE" for what Scene::check() refuses
Scene read_scene_csv(const std::filesystem::path& folder, const std::filesystem::path& table, double margin);

}  // namespace sixdof::scene
