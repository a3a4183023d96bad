#pragma once

#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <sixdof/algorithm/core_algorithms.h>
#include <sixdof/query/algorithm.h>

#include "../bench/faulty_pose.h"

/// Algorithms that answer as `exact` does but end, or stop, their process at one pose in 20 (faulty_pose.h).

namespace sixdof::test {

/// For the compiler, something that might change.
inline volatile bool always = true;
inline void* volatile nowhere = nullptr;

// NOLINTNEXTLINE(misc-no-recursion): on purpose
[[gnu::noinline]] inline int overflow_stack(int depth) {
  std::array<volatile char, 4096> frame{};
  frame[static_cast<std::size_t>(depth) % frame.size()] = 1;
  if (always) depth += overflow_stack(depth + 1);
  return depth + frame[0];
}

inline void take_memory() {
  constexpr std::size_t k_block = std::size_t{16} << 20;
  std::vector<std::unique_ptr<char[]>> blocks;
  while (always) {
    blocks.emplace_back(new char[k_block]);
    for (std::size_t i = 0; i < k_block; i += 4096) blocks.back()[i] = 1;
  }
}

/// std::bad_alloc ends the program.
inline void take_memory_without_exceptions() noexcept { take_memory(); }

inline void close_everything() {
  constexpr int k_most = 1024;
  for (int descriptor = 0; descriptor < k_most; ++descriptor) ::close(descriptor);
  while (always) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

struct Death {
  const char* name;  ///< Of the algorithm.
  Status status;     ///< What the pose gets.
  void (*die)();
};

inline const std::vector<Death>& deaths() {
  static const std::vector<Death> list{
      {"segfault", Status::crashed, [] { *static_cast<volatile int*>(nowhere) = 1; }},
      {"abort", Status::crashed, [] { std::abort(); }},
      {"stack-overflow", Status::crashed, [] { overflow_stack(0); }},
      {"exit", Status::crashed, [] { std::exit(0); }},
      {"closes-streams", Status::crashed, close_everything},
      {"endless-loop", Status::timed_out,
       [] {
         while (always) continue;
       }},
      {"bad-alloc", Status::out_of_memory, take_memory},
      {"memory-abort", Status::out_of_memory, take_memory_without_exceptions},
      {"chatty", Status::ok, [] { std::puts("{\"collide\": true} printed by a library"); }},
  };
  return list;
}

class DeadlyQuery final : public Query {
 public:
  DeadlyQuery(std::unique_ptr<Query> exact, const Death& death) : exact_(std::move(exact)), death_(death) {}
  Outcome<bool> collide(const Pose& X_AB) override { return at(X_AB).collide(X_AB); }
  Outcome<Separation> distance(const Pose& X_AB) override { return at(X_AB).distance(X_AB); }
  Outcome<Response> respond(const Pose& X_AB) override { return at(X_AB).respond(X_AB); }

 private:
  Query& at(const Pose& X_AB) {
    if (is_faulty(X_AB)) death_.die();
    return *exact_;
  }

  std::unique_ptr<Query> exact_;
  const Death& death_;
};

class DeadlyAlgorithm final : public Algorithm {
 public:
  explicit DeadlyAlgorithm(const Death& death) : death_(death) {
    traits_ = {.name = death.name,
               .version = "1",
               .summary = "ends its process at one pose in 20",
               .answers = {.collide = true, .distance = true, .respond = true},
               .law = ResponseLaw::volume};
  }
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings&) const override {
    const auto exact = make_exact_algorithm();
    return std::make_unique<DeadlyQuery>(exact->prepare(a, b, exact->settings()), death_);
  }

 private:
  const Death& death_;
  Traits traits_;
};

}  // namespace sixdof::test
