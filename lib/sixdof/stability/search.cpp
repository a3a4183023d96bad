#include <sixdof/stability/search.h>

#include <cmath>
#include <random>
#include <utility>

namespace sixdof::stability {
namespace {

/// In [0, 1), the same on every machine.
double unit(std::mt19937_64& random) {
  constexpr int k_unused_bits = 11;
  return static_cast<double>(random() >> k_unused_bits) * 0x1p-53;
}

Genes mutant(const Genes& parent, double step, std::mt19937_64& random) {
  Genes child = parent;
  constexpr double k_changed = 1.0 / 3.0;
  for (double& gene : child) {
    if (unit(random) >= k_changed) continue;
    gene += step * (2.0 * unit(random) - 1.0);
    gene -= std::floor(gene);  // angles go round; ends of a sweep are rarely the only worst place
    if (gene >= 1.0) gene = 0.0;
  }
  return child;
}

}  // namespace

bool worse_answer(const Judgement& one, const Judgement& other) { return one.worst().worse_than(other.worst()); }

bool slower(const Judgement& one, const Judgement& other) { return one.slowest_seconds > other.slowest_seconds; }

Judged search_worst(const Family& family, Judged start, const JudgeCase& judge_case, const Worse& worse,
                    std::size_t generations, std::size_t children, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  constexpr double k_first_step = 0.3, k_shrink = 0.7;
  double step = k_first_step;
  for (std::size_t g = 0; g < generations; ++g, step *= k_shrink) {
    Judged best = start;
    for (std::size_t c = 0; c < children; ++c) {
      Judged child{.genes = mutant(start.genes, step, random), .member = {}, .judgement = {}};
      Draw draw(child.genes);
      child.member = family.make(draw);
      child.judgement = judge_case(child.genes, child.member);
      if (worse(child.judgement, best.judgement)) best = std::move(child);
    }
    start = std::move(best);
  }
  return start;
}

}  // namespace sixdof::stability
