#pragma once

#include <memory>

#include <sixdof/scenario/scenario.h>

namespace sixdof {

/// Scenarios Ia (thick block) and Ib (thin plate): a cone, apex down, slides along a block at a constant depth.
///
/// A's frame: x along the block, y up, z across; the block is [0, L] x [-h, 0] x [-w/2, w/2]. B's frame: apex at the
/// origin, axis +y. Pose: translation by (x, -depth, 0), x from -overshoot to L + overshoot. Reference point: middle of
/// the cone's bounding box. README.md derives the ideal models.
Settings cone_block_settings(bool thin);

/// @param thin selects the name and the purpose only. @throws BadArgument
std::unique_ptr<Scenario> make_cone_block(const Settings& settings, bool thin);

}  // namespace sixdof
