#include <sixdof/process/spare_process.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>

#include <sixdof/process/remote_query.h>

namespace sixdof {
namespace {

template <class Element>
std::span<const std::byte> bytes_of(const std::vector<Element>& elements) {
  return std::as_bytes(std::span(elements));
}

}  // namespace

PairFiles::PairFiles(const Mesh& a, const Mesh& b)
    : vertices_a("vertices of A", {}),
      triangles_a("triangles of A", {}),
      progress("progress", bytes_of(std::vector<std::uint64_t>{0})),
      vertices_b("vertices of B", {}),
      triangles_b("triangles of B", {}),
      counter(progress.descriptor()) {
  set(a, b);
}

void PairFiles::set(const Mesh& a, const Mesh& b) {
  vertices_a.replace(bytes_of(a.vertices()));
  triangles_a.replace(bytes_of(a.triangles()));
  const bool copies = &a == &b;
  vertices_b.replace(copies ? std::span<const std::byte>() : bytes_of(b.vertices()));
  triangles_b.replace(copies ? std::span<const std::byte>() : bytes_of(b.triangles()));
  counter.set(0);
}

std::vector<int> PairFiles::descriptors() const {
  return {vertices_a.descriptor(), triangles_a.descriptor(), progress.descriptor(), vertices_b.descriptor(),
          triangles_b.descriptor()};
}

void SpareProcesses::put(Parts parts) {
  Parts oldest;  // ends after the lock is free: that takes a while
  const std::lock_guard lock(mutex_);
  if (parts_.size() == k_most) {
    oldest = std::move(parts_.front());
    parts_.erase(parts_.begin());
  }
  parts_.push_back(std::move(parts));
}

SpareProcesses::Parts SpareProcesses::take() {
  const std::lock_guard lock(mutex_);
  const auto is_mine = [](const Parts& each) { return each.process->ends_with_this_thread(); };
  const auto last = std::find_if(parts_.rbegin(), parts_.rend(), is_mine);
  if (last == parts_.rend()) return {};
  Parts parts = std::move(*last);
  parts_.erase(std::prev(last.base()));
  return parts;
}

RemoteProgram remote_program(std::vector<std::string> words, const ProcessLimits& limits) {
  return {std::move(words), limits, limits.reuse ? std::make_shared<SpareProcesses>() : nullptr};
}

}  // namespace sixdof
