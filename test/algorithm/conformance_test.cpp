// The library's own algorithms, as the conformance kit holds every algorithm to its rules.

#include <sixdof/conformance/conformance.h>

#include <sixdof/algorithm/core_algorithms.h>

namespace sixdof {
namespace {

using conformance::Meaning;

SIXDOF_CONFORMANCE(make_exact_algorithm, {.collide = Meaning::bodies});
SIXDOF_CONFORMANCE(make_brute_force_algorithm);

}  // namespace
}  // namespace sixdof
