#pragma once

#include <array>

/// Internal: use DistanceQuery.
namespace sixdof::detail {

/// Directions of the rays that count how a surface winds around a point, in A's frame, of about unit length; tried in
/// turn. Unrelated to each other and to A's axes; a pose may turn B's axes along any of them.
inline constexpr std::array<std::array<double, 3>, 8> k_winding_rays{{{0.8217, 0.3391, 0.4583},
                                                                      {-0.2861, 0.7127, 0.6405},
                                                                      {0.1379, -0.5623, 0.8153},
                                                                      {-0.6427, -0.4919, 0.5871},
                                                                      {0.4339, 0.2671, -0.8605},
                                                                      {-0.7193, 0.5281, -0.4513},
                                                                      {0.3067, -0.8837, -0.3533},
                                                                      {-0.4801, -0.3169, -0.8179}}};

}  // namespace sixdof::detail
