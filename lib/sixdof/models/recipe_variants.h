#pragma once

#include <span>

#include <sixdof/models/recipe.h>

namespace sixdof {

/// Recipes with other parameters, for a collection of many shapes: `plate-10k`, `gyroid-ball-fine-50k`. They differ
/// from recipes() in nothing but that; `summary` states the parameters.
std::span<const Recipe> recipe_variants();

}  // namespace sixdof
