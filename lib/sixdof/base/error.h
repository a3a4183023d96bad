#pragma once

#include <stdexcept>
#include <string>

namespace sixdof {

/// Root of all exceptions of this library. Queries do not throw: they return an Outcome.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An argument that cannot be honoured: a name that does not exist, a number out of range.
class BadArgument : public Error {
 public:
  using Error::Error;
};

/// Geometry that cannot be used: an index out of range, a vertex that is not finite, a surface with a border where a
/// closed one is needed.
class BadMesh : public Error {
 public:
  using Error::Error;
};

/// A file that cannot be read, is malformed, damaged or of another kind, or cannot be written. The message reads
/// "FILE: LOCATION: CAUSE" or "FILE: CAUSE", e.g. "hull.off: face 7: vertex index 12 of 9".
class BadFile : public Error {
 public:
  BadFile(const std::string& file, const std::string& cause) : Error(file + ": " + cause) {}
  BadFile(const std::string& file, const std::string& location, const std::string& cause)
      : Error(file + ": " + location + ": " + cause) {}
};

/// Work ended because the user asked for it (Ctrl-C). No file is left half written.
class Interrupted : public Error {
 public:
  using Error::Error;
};

}  // namespace sixdof
