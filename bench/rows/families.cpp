#include "bench/rows/families.h"

namespace sixdof::bench {

void add_all_rows(Suite& suite) {
  add_prepare_rows(suite);
  add_query_rows(suite);
  add_scenario_rows(suite);
  add_kernel_rows(suite);
  add_generate_rows(suite);
}

}  // namespace sixdof::bench
