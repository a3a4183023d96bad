// The header alone, with the nanoflann of CMakeLists.txt.
#include <sixdof/repair/neighbours.h>
