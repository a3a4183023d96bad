#pragma once

#include <vector>

#include <sixdof/stability/judge.h>

namespace sixdof::stability {

/// Relation::contacts: contacts of bodies that overlap by -GroundTruth::gap along GroundTruth::push, in every shot.
/// Wrong are: no contact, a contact off both bodies, a normal away from all true ones (JudgedContact), a mean normal
/// that leads into A, and one that is turned round in another frame or with A and B exchanged. Of depths of bodies
/// (ContactDepth::bodies) the largest is compared with the true one. How far normals are from the shortest way
/// out is not wrong: contacts of triangles promise no more. Nothing is judged of an algorithm that gives no contacts.
void judge_contacts(const Case& member, const Traits& traits, const Prepare& prepare, const Limits& limits,
                    std::vector<Finding>& findings);

}  // namespace sixdof::stability
