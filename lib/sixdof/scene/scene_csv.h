#pragma once

#include <filesystem>

#include <sixdof/scene/scene.h>

namespace sixdof::scene {

/// A scene of mesh files and a table of poses (CSV). The first line of the table names its columns, in any order:
///
///     frame,body,mesh,tx,ty,tz,qw,qx,qy,qz
///     0,1,hull.stl,0,0,0,1,0,0,0
///     0,2,part.obj,1.5,0,0,1,0,0,0
///     1,2,,1.4,0,0,1,0,0,0
///
/// A row is a body's pose X_WB from that frame on: translation (length) and unit quaternion. Frames are numbered from 0
/// and do not decrease; a body that has no row in a frame stays where it is. `body` is its identifier. Every body has a
/// row in frame 0, with the file of its mesh in the folder; later rows may leave the file out. A column `fixed` is
/// optional: 1 in frame 0 for a body that never moves. Empty lines and those that begin with # are skipped.
///
/// @param margin of the query for near pairs (length)
/// @throws BadFile "FILE: line N: CAUSE" for a table that is wrong, and as load_mesh() does; BadArgument as
/// Scene::check() does
Scene read_scene_csv(const std::filesystem::path& folder, const std::filesystem::path& table, double margin);

}  // namespace sixdof::scene
