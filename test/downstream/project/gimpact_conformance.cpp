#include <sixdof/conformance/conformance.h>

const char* const k_why = "takes what is behind a triangle, in its box, for a contact";
const char* const k_issue = "bulletphysics/bullet3#4318";

SIXDOF_CONFORMANCE("gimpact", {.known_failures = {{"Collide", k_why, k_issue}, {"MotionOfCollide", k_why, k_issue}}});
