#include <algorithm>

#include <sixdof/report/tables.h>

namespace sixdof::report {

DataTable collection_table(const Results& results) {
  DataTable table{.name = "collection",
                  .title = "Times over the objects of the collection",
                  .columns = {"run", "partner", "query", "bucket", "percent", "algorithm", "objects", "mean_us",
                              "p10_us", "p90_us", "slowest_object", "slowest_us"},
                  .rows = {}};
  for (const CollectionCell& cell : results.collection.cells) {
    if (cell.algorithm == "null") continue;
    table.rows.push_back({run_name(results, cell.file), cell.partner, cell.query, to_string(cell.bucket.kind),
                          cell.bucket.percent, cell.algorithm, static_cast<double>(cell.objects), cell.mean_us,
                          cell.p10_us, cell.p90_us, cell.greatest_object, cell.greatest_us});
  }
  return table;
}

DataTable collection_ratios_table(const Results& results) {
  DataTable table{.name = "collection_ratios",
                  .title = "Time over that of exact on the same object",
                  .columns = {"run", "partner", "query", "algorithm", "objects", "point", "ratio", "p10", "p90"},
                  .rows = {}};
  for (const CollectionRatio& each : results.collection.ratios) {
    if (each.algorithm == "null" || each.algorithm == "exact") continue;
    const std::string run = run_name(results, each.file);
    table.rows.push_back({run, each.partner, each.query, each.algorithm, static_cast<double>(each.objects),
                          std::string(k_mean_of_objects), each.ratio, each.p10, each.p90});
    for (const auto& [object, ratio] : each.worst) {
      table.rows.push_back({run, each.partner, each.query, each.algorithm, Cell(), object, ratio, Cell(), Cell()});
    }
  }
  return table;
}

DataTable growth_table(const Results& results) {
  DataTable table{.name = "growth",
                  .title = "Growth with the number of triangles",
                  .columns = {"run", "quantity", "shape", "algorithm", "triangles", "value"},
                  .rows = {}};
  for (const GrowthSeries& series : results.growth) {
    for (const auto& [shape, points] : series.points) {
      for (const auto& [triangles, value] : points) {
        table.rows.push_back(
            {run_name(results, series.file), series.quantity, shape, series.algorithm, triangles, value});
      }
    }
  }
  return table;
}

DataTable growth_exponents_table(const Results& results) {
  DataTable table{.name = "growth_exponents",
                  .title = "Exponents of the number of triangles",
                  .columns = {"run", "quantity", "algorithm", "exponent", "low", "high"},
                  .rows = {}};
  for (const GrowthSeries& series : results.growth) {
    if (!series.law) continue;
    const auto& [exponent, half_width, points] = *series.law;
    table.rows.push_back({run_name(results, series.file), series.quantity, series.algorithm, exponent,
                          exponent - half_width, exponent + half_width});
  }
  return table;
}

}  // namespace sixdof::report
