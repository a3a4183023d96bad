#pragma once

#include <mutex>

namespace sixdof {

/// Holds ODE for this thread, and initialises it: its colliders, and its lists of geometries, belong to the process.
/// Every call of ODE is made under one. What ODE reports as an error is thrown as std::runtime_error.
class OdeLock {
 public:
  OdeLock();  ///< @throws std::runtime_error where ODE cannot be initialised

 private:
  std::lock_guard<std::mutex> lock_;
};

}  // namespace sixdof
