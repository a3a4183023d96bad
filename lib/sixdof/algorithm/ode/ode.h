#pragma once

#include <memory>

#include <sixdof/query/registry.h>

namespace sixdof {

/// `ode`: the Open Dynamics Engine's collision of two triangle meshes, with OPCODE. Answers collide, respond and
/// contacts.
///
/// **Precision.** ODE is compiled for double precision. OPCODE's trees of axis-aligned boxes are in single precision;
/// pairs of triangles are computed in double precision.
///
/// **Prepare** builds OPCODE's tree of each mesh; it refers to the mesh's own arrays. **A query** moves B's geometry
/// and calls dCollide() for the pair, without a space. collide asks for one contact and says that the contacts do not
/// matter (CONTACTS_UNIMPORTANT), as ODE's manual has it; OPCODE collects all pairs of triangles nonetheless. respond
/// asks for all, contacts for as many as it is asked for. Nothing is kept from query to query:
/// OPCODE's temporal coherence is off, as by default.
///
/// **Contacts** become a wrench by the rule of algorithm/contact_wrench.h. ODE counts contacts in 16 bits, so a query
/// with `max_contacts` or more of them fails.
///
/// **Threads.** The package is compiled without `ODE_EXT_mt_collisions`: OPCODE's colliders are shared by the process.
/// Queries take turns; a mutex serves one at a time.
///
/// **Process.** The first preparation initialises ODE for the rest of the process, silences its messages and turns its
/// errors, which would end the process, into failed queries.
///
/// **Known failures.** Surfaces only: a body wholly inside the other does not collide. A depth is that of pairs of
/// triangles that intersect: parts of a body that are deeper than these do not count.
std::unique_ptr<Algorithm> make_ode_algorithm();

/// Adds it.
void register_ode_algorithms(Registry& registry);

}  // namespace sixdof
