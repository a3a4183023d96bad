#pragma once

#include <cstddef>

#include <sixdof/repair/repair.h>
#include <sixdof/repair/surface.h>

namespace sixdof::repairing {

/// Turns triangles so that neighbours agree. A patch is what edges of two triangles connect.
/// - A closed patch that is in no other closed patch faces outwards.
/// - A closed patch inside of another keeps the direction of most of its triangles, and is turned over if the outermost
///   patch around it is: a cavity stays one.
/// - An open patch keeps the direction of most of its triangles.
/// - A patch with one side only (a Moebius strip) stays as it is.
/// @return repairs made
std::size_t orient(Surface& surface, RepairLog& log);

}  // namespace sixdof::repairing
