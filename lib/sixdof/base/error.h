#pragma once

#include <stdexcept>
#include <string>

namespace sixdof {

/// Root of all exceptions of this library. Queries do not throw: they return an Outcome.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An argument that cannot be honoured: a name that does not exist, a number out of range.
struct BadArgument : Error {
  using Error::Error;
};

/// Geometry that cannot be used: an index out of range, a vertex that is not finite, a surface with a border where a
/// closed one is needed.
struct BadMesh : Error {
  using Error::Error;
};

/// A file that cannot be read, is malformed, damaged or of another kind, or cannot be written. The message reads
/// "FILE: LOCATION: CAUSE" or "FILE: CAUSE", e.g. "hull.off: face 7: vertex index 12 of 9".
struct BadFile : Error {
  /// "FILE: CAUSE".
  BadFile(const std::string& file, const std::string& cause) : Error(file + ": " + cause) {}
  /// "FILE: LOCATION: CAUSE"; a location is an element, from 0, or a line, from 1.
  BadFile(const std::string& file, const std::string& location, const std::string& cause)
      : Error(file + ": " + location + ": " + cause) {}
};

/// Work ended because the user asked for it (Ctrl-C). No file is left half written.
struct Interrupted : Error {
  using Error::Error;
};

}  // namespace sixdof
