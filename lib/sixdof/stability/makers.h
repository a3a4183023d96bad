#pragma once

#include <vector>

#include <sixdof/stability/case.h>
#include <sixdof/stability/draw.h>

/// Generators of the families, by the file that holds them.
namespace sixdof::stability::make {

// family_scale.cpp: what scales and moves.
Case uniform_scale(Draw& draw);
Case size_ratio(Draw& draw);
Case common_offset(Draw& draw);
Case rigid_motion(Draw& draw);

// family_contact.cpp: bodies that nearly touch, or are nearly parallel.
Case kissing_boxes(Draw& draw);
Case near_aligned(Draw& draw);
Case parallel_edges(Draw& draw);
Case identical(Draw& draw);
Case grazing(Draw& draw);

// family_mesh.cpp: triangles that are bad, or many for a simple body.
Case slivers(Draw& draw);
Case zero_area(Draw& draw);
Case retriangulated(Draw& draw);
Case holes(Draw& draw);

// family_depth.cpp: deep, thin, fast.
Case contained(Draw& draw);
Case thin_plate(Draw& draw);
Case tunnelling(Draw& draw);

// family_path.cpp: poses that are none, and sequences of poses.
Case bad_poses(Draw& draw);
Case lipschitz(Draw& draw);
Case closed_loop(Draw& draw);
Case repeated(Draw& draw);
Case worst_time(Draw& draw);

// family_cast.cpp: motions, and when they end.
Case moving_bodies(Draw& draw);

// family_contacts.cpp: bodies that overlap along a known direction.
Case contacts(Draw& draw);

/// Two convex bodies at a generic pose: apart, or overlapping by a face or along axes.
Shot base(Draw& draw);

/// A random frame for a body whose size is about 1.
Placement frame(Draw& draw, double largest_shift = 1.0);

/// The shot; the same with A and B exchanged; the same with both meshes in random frames of their own.
std::vector<Shot> in_other_frames(const Shot& shot, Draw& draw);

/// Edges of the boxes of most families.
inline const Eigen::Vector3d k_size_a{2.0, 1.6, 1.2};
inline const Eigen::Vector3d k_size_b{0.5, 0.4, 0.3};

}  // namespace sixdof::stability::make

/// Field cases, by the file that holds them.
namespace sixdof::stability::field {

// field_triangles.cpp
std::vector<Case> triangle_offsets();
std::vector<Case> triangle_slivers();
std::vector<Case> triangle_parallel();
std::vector<Case> triangle_kissing();
std::vector<Case> triangle_sizes();
std::vector<Case> triangle_deep();

// field_bodies.cpp
std::vector<Case> body_scales();
std::vector<Case> body_sizes();
std::vector<Case> body_offsets();
std::vector<Case> body_kissing();
std::vector<Case> body_aligned();
std::vector<Case> body_parallel();
std::vector<Case> body_grazing();
std::vector<Case> body_deep();
std::vector<Case> body_thin();

// field_other.cpp
std::vector<Case> retriangulations();
std::vector<Case> damaged();
std::vector<Case> fast();
std::vector<Case> inputs();
std::vector<Case> repeats();
std::vector<Case> motions();

}  // namespace sixdof::stability::field
