#pragma once

#include <stdexcept>
#include <string>

namespace sixdof {

/// Root of everything this library throws at its boundary. Queries do not throw; they return an Outcome.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An argument that cannot be honoured: a name that does not exist, a number out of range.
class BadArgument : public Error {
 public:
  using Error::Error;
};

/// Geometry that cannot be honoured: an index out of range, a vertex that is not finite, an open mesh where a closed
/// one is needed.
class BadMesh : public Error {
 public:
  using Error::Error;
};

/// A file that cannot be read, is malformed, damaged or foreign, or cannot be written. The message reads
/// "FILE: PLACE: CAUSE" (PLACE may be absent), e.g. "hull.off: face 7: vertex index 12 of 9".
class BadFile : public Error {
 public:
  BadFile(const std::string& file, const std::string& cause) : Error(file + ": " + cause) {}
  BadFile(const std::string& file, const std::string& place, const std::string& cause)
      : Error(file + ": " + place + ": " + cause) {}
};

/// Work stopped because the user asked for it (Ctrl-C). Nothing half-written is left behind.
class Interrupted : public Error {
 public:
  using Error::Error;
};

}  // namespace sixdof
