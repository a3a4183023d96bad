#pragma once

#include <string>

#include "bench/study/study_sample.h"

namespace sixdof::study {

/// The poses that a verdict on a pair rests on.
///
/// collide: a third each of
///   - poses of the set that are 1 % of A's diagonal or more apart;
///   - poses near contact: of a pose of the set, B is moved along the shortest way to A until the surfaces are 0.01,
///   0.1
///     or 0.3 % of A's diagonal apart, or until B is pushed in as far;
///   - overlaps: those of the set or, where it has none, B pushed in by 1, 2 or 5 %.
/// distance: half of it apart, half near contact without touching. respond: overlaps of the set.
/// The truth of moved poses is that of the distance oracle. Those whose truth is not on the side that was meant are
/// left out; so are whole parts that the set has no poses for.
/// @param count poses in all
/// @throws BadArgument if there are no poses at all; NeedsSolid (respond); BadFile
StudySample draw_verdict_sample(bench::PairCache& cache, const CatalogueEntry& pair, bench::QueryKind question,
                                std::size_t count);

/// "700 poses apart, 700 near contact, 700 overlapping".
std::string poses_text(const StudySample& sample);

}  // namespace sixdof::study
