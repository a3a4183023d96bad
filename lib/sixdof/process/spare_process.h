#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <sixdof/geometry/mesh.h>
#include <sixdof/process/child_process.h>
#include <sixdof/process/protocol.h>
#include <sixdof/process/shared_memory.h>

namespace sixdof {

/// Numbers of the descriptors as the program finds them.
enum Descriptor {
  k_vertices_a = 3,
  k_triangles_a,
  k_progress,
  k_vertices_b,
  k_triangles_b
};

/// What a process reads of a pair, and where it counts. Those of B are empty if it is a copy of A.
struct PairFiles {
  /// @throws Error
  PairFiles(const Mesh& a, const Mesh& b);

  /// Another pair in the same files. @throws Error
  void set(const Mesh& a, const Mesh& b);

  /// In the order of Descriptor.
  std::vector<int> descriptors() const;

  MemoryFile vertices_a, triangles_a, progress, vertices_b, triangles_b;
  SharedCounter counter;
};

/// The process of a pair that is no longer needed, for a later one.
class SpareProcess {
 public:
  struct Parts {
    std::unique_ptr<PairFiles> files;
    std::unique_ptr<ChildProcess> process;
    protocol::Greeting greeting;
  };
  /// One at most is kept: another one ends.
  void put(Parts parts) {
    const std::lock_guard lock(mutex_);
    parts_ = std::move(parts);
  }
  /// Without a process if there is none that this thread made: one of another thread may end at any time, with it.
  Parts take() {
    const std::lock_guard lock(mutex_);
    if (!parts_.process || !parts_.process->ends_with_this_thread()) return {};
    return std::exchange(parts_, {});
  }

 private:
  std::mutex mutex_;
  Parts parts_;
};

}  // namespace sixdof
