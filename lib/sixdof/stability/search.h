#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include <sixdof/stability/draw.h>
#include <sixdof/stability/families.h>
#include <sixdof/stability/judge.h>

/// Looks for a worse case than the sampled ones.
namespace sixdof::stability {

/// A case with what one algorithm made of it.
struct Judged {
  Genes genes{};
  Case member;
  Judgement judgement;
};

/// Which of two is worse.
using Worse = std::function<bool(const Judgement& one, const Judgement& other)>;

/// By Finding::worse_than().
bool worse_answer(const Judgement& one, const Judgement& other);
/// By the processor time of the slowest query.
bool slower(const Judgement& one, const Judgement& other);

/// Judges the case of some genes.
using JudgeCase = std::function<Judgement(const Genes& genes, const Case& member)>;

/// A (1 + lambda) evolution strategy on the genes: `generations` times the worst of `children` mutants replaces the
/// parent if it is worse. Mutants differ in a third of the genes, by steps that shrink. Deterministic by `seed` if the
/// judgements are.
Judged search_worst(const Family& family, Judged start, const JudgeCase& judge_case, const Worse& worse,
                    std::size_t generations, std::size_t children, std::uint64_t seed);

}  // namespace sixdof::stability
