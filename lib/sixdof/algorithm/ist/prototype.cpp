#include <sixdof/algorithm/ist/prototype.h>

#include <algorithm>
#include <cstddef>

#include <sixdof/algorithm/ist/clearance_model.h>
#include <sixdof/base/parallel.h>

namespace sixdof::ist {
namespace {

constexpr int k_max_doublings = 40;          // of the clearance, in the first phase
constexpr int k_max_model_steps = 64;        // measured clearances in the second phase; narrow wedges need many
constexpr double k_min_gain = 1e-2;          // converged when the model promises a smaller relative gain than this
constexpr std::size_t k_starts_a_task = 32;  // several times as many as there are slots

/// Searches that go on side by side, each in a slot; a slot whose search has ended takes the next start.
class Climb {
 public:
  Climb(const FreeSpace& space, std::span<const Start> starts, std::span<Prototype> found)
      : starts_(starts), found_(found), slots_(ClearanceModels::k_slots, Slot{ClearanceQuery(space)}) {}

  void run() {
    while (fill_slots()) {
      for (std::size_t s = 0; s < slots_.size(); ++s) {
        if (slots_[s].prototype != nullptr) models_.set_start(s, slots_[s].prototype->position, slots_[s].trust);
      }
      models_.maximise();
      for (std::size_t s = 0; s < slots_.size(); ++s) {
        if (slots_[s].prototype != nullptr && !measure_next(s)) slots_[s].prototype = nullptr;
      }
    }
  }

 private:
  struct Slot {
    ClearanceQuery clearance;
    Prototype* prototype = nullptr;  ///< The best place so far; null: the slot is free.
    double trust = 0.0;
    int steps = 0;
  };

  /// @return whether a slot is in use
  bool fill_slots() {
    bool any = false;
    for (std::size_t s = 0; s < slots_.size(); ++s) {
      while (slots_[s].prototype == nullptr && next_ < starts_.size()) {
        const bool goes_on = begin(s, starts_[next_], found_[next_]);
        if (goes_on) slots_[s].prototype = &found_[next_];
        ++next_;
      }
      any = any || slots_[s].prototype != nullptr;
    }
    return any;
  }

  /// First phase. @return whether there is a second one
  bool begin(std::size_t s, const Start& start, Prototype& best) {
    Slot& slot = slots_[s];
    slot.clearance.reset();
    models_.reset(s);
    best.position = start.position;
    auto here = slot.clearance(start.position, start.bound);
    if (here.value < start.min_clearance) return false;
    best.clearance = here.value;
    for (int i = 0; i < k_max_doublings && here.value > 0.0; ++i) {
      models_.add(s, here.obstacle);
      const Eigen::Vector3d next = best.position + here.obstacle.away(best.position) * (0.99 * best.clearance);
      here = slot.clearance(next, 2.0 * best.clearance);
      const bool slowing = here.value < 1.5 * best.clearance;
      take_if_better(best, next, here.value);
      if (slowing) break;
    }
    models_.add(s, here.obstacle);
    slot.trust = 0.9 * best.clearance;
    slot.steps = 0;
    return best.clearance > 0.0;
  }

  /// A step of the second phase, from what the model found. @return whether there is a next one
  bool measure_next(std::size_t s) {
    Slot& slot = slots_[s];
    Prototype& best = *slot.prototype;
    if (models_.clearance(s) < best.clearance * (1.0 + k_min_gain)) return false;
    const Eigen::Vector3d next = models_.place(s);
    const auto here = slot.clearance(next, best.clearance + slot.trust);
    models_.add(s, here.obstacle);
    if (take_if_better(best, next, here.value)) {
      slot.trust = std::min(1.5 * slot.trust, 0.9 * best.clearance);
    } else {
      slot.trust *= 0.6;
    }
    return ++slot.steps < k_max_model_steps;
  }

  static bool take_if_better(Prototype& best, const Eigen::Vector3d& place, double clearance) {
    if (!(clearance > best.clearance)) return false;
    best.position = place;
    best.clearance = clearance;
    return true;
  }

  std::span<const Start> starts_;
  std::span<Prototype> found_;
  std::size_t next_ = 0;  ///< The first start that no slot has taken.
  ClearanceModels models_;
  std::vector<Slot> slots_;
};

}  // namespace

std::vector<Prototype> find_prototypes(const FreeSpace& space, std::span<const Start> starts, std::uint64_t first) {
  std::vector<Prototype> found(starts.size());
  for (std::size_t i = 0; i < found.size(); ++i) found[i].order = first + i;
  const std::size_t tasks = (starts.size() + k_starts_a_task - 1) / k_starts_a_task;
  parallel::for_each(tasks, [&](std::size_t task) {
    const std::size_t begin = task * k_starts_a_task, count = std::min(k_starts_a_task, starts.size() - begin);
    Climb(space, starts.subspan(begin, count), std::span(found).subspan(begin, count)).run();
  });
  return found;
}

}  // namespace sixdof::ist
