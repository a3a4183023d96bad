// Draws every figure that has data as an SVG file, at the default of each choice, with its legend and a title.
//   node write_svg.js REPORT_FOLDER DATA.json OUTPUT_FOLDER
// REPORT_FOLDER has page/ and vendor/. Prints the name of every file that it wrote.

"use strict";

const fs = require("fs");
const path = require("path");
const vm = require("vm");

const [folder, dataFile, output] = process.argv.slice(2);
const load = (file) => vm.runInThisContext(fs.readFileSync(path.join(folder, file), "utf8"), { filename: file });
// Under node, Vega's file would be a module; as a script of a page it sets a global.
for (const file of ["vendor/vega.min.js", "vendor/vega-lite.min.js", "page/figure_spec.js"]) load(file);

const report = globalThis.sixdofReport;
const data = report.unpack(JSON.parse(fs.readFileSync(dataFile, "utf8")));

function titleOf(meta, choices, facet) {
  const said = meta.filters.map((filter) => choices[filter.field]).filter((value) => value !== undefined && value !== "all");
  return { text: meta.title, subtitle: [...said, ...(facet === null ? [] : [facet])].join(", ") };
}

async function write(id, figure) {
  const meta = figure.usermeta;
  const { resolved, rows } = report.resolveChoices(figure, report.figureRows(figure, data.tables), {});
  if (rows.length === 0) return;
  const choices = Object.fromEntries(resolved.map(({ filter, value }) => [filter.field, value]));
  for (const facet of meta.facet ? report.valuesOf(rows, meta.facet) : [null]) {
    const part = facet === null ? rows : rows.filter((row) => row[meta.facet] === facet);
    const spec = report.prepareSpec(figure, part, choices, { theme: "light", algorithms: data.algorithms, width: 560, legend: true,
                                                             linear: false, title: titleOf(meta, choices, facet) });
    const view = new vega.View(vega.parse(vegaLite.compile(spec).spec), { renderer: "none" });
    const name = facet === null ? `${id}.svg` : `${id}-${String(facet).replace(/[^A-Za-z0-9-]/g, "_")}.svg`;
    fs.writeFileSync(path.join(output, name), await view.toSVG());
    view.finalize();
    console.log(name);
  }
}

(async () => {
  for (const [id, figure] of Object.entries(data.figures)) await write(id, figure);
})().catch((error) => {
  console.error(String(error && error.stack || error));
  process.exit(1);
});
