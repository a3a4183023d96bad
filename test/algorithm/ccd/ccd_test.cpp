#include <sixdof/algorithm/ccd/ccd.h>

#include "../hull_checks.h"

namespace sixdof {
namespace {

TEST(CcdHull, AnswersForTheHulls) {
  for (const std::string method : {"method=gjk", "method=mpr"}) {
    test::expect_answers_for_hulls(*make_ccd_hull_algorithm(), {method});
    test::expect_yes_where_meshes_are_apart(*make_ccd_hull_algorithm(), {method});
  }
}

TEST(CcdHull, IsLabelledAndFailsOnAPoseThatIsNotFinite) { test::expect_hull_manners(*make_ccd_hull_algorithm()); }

}  // namespace
}  // namespace sixdof
