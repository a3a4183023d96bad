#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
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

/// Processes of pairs that are no longer needed, for later ones.
class SpareProcesses {
 public:
  struct Parts {
    std::unique_ptr<PairFiles> files;
    std::unique_ptr<ChildProcess> process;
    protocol::Greeting greeting;
  };
  /// Keeps it; beyond k_most the oldest one ends.
  void put(Parts parts);
  /// The latest that this thread made: one of another thread may end at any time, with it. Without a process if there
  /// is none.
  Parts take();

  static constexpr std::size_t k_most = 8;

 private:
  std::mutex mutex_;
  std::vector<Parts> parts_;  ///< The oldest first.
};

}  // namespace sixdof
