// Draws every figure that has data as an SVG file, with its legend and a title: at the choices that the data name under
// "choices", at the default of all others.
//   node write_svg.js REPORT_FOLDER DATA.json OUTPUT_FOLDER
// REPORT_FOLDER has page/ and vendor/. Prints the name of every file that it wrote. Ends with 3 and a line of why where
// no figure offers a choice.

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

/** Why a wanted choice is none; empty if a figure offers it under the choices before it. */
function refusal(field, wanted) {
  const offered = Object.values(data.figures).flatMap((figure) => {
    const { resolved } = report.resolveChoices(figure, report.figureRows(figure, data.tables), data.choices, data.metrics);
    return resolved.filter(({ filter }) => filter.field === field).flatMap(({ values }) => values.map(String));
  });
  if (offered.includes(String(wanted))) return "";
  if (offered.length > 0) return `--choose ${field}=${wanted}: no figure offers it, but ${[...new Set(offered)].slice(0, 12).join("; ")}`;
  const fields = Object.values(data.figures).flatMap(({ usermeta: meta }) => [...(meta.filters || []), ...(meta.axes || [])].map((each) => each.field));
  return `--choose ${field}=${wanted}: no figure has this choice, but ${[...new Set(fields)].sort().join(", ")}`;
}

function titleOf(meta, choices, facet) {
  const said = meta.filters.map((filter) => choices[filter.field]).filter((value) => value !== undefined && value !== "all");
  return { text: meta.title, subtitle: [...said, ...(facet === null ? [] : [facet])].join(", ") };
}

async function write(id, figure) {
  const meta = figure.usermeta;
  const { choices, rows: chosen } = report.resolveChoices(figure, report.figureRows(figure, data.tables), data.choices, data.metrics);
  const rows = report.withAxes(figure, chosen, choices, data.metrics);
  if (rows.length === 0) return;
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
  for (const [field, wanted] of Object.entries(data.choices)) {
    const why = refusal(field, wanted);
    if (why) {
      console.error(why);
      process.exit(3);
    }
  }
  for (const [id, figure] of Object.entries(data.figures)) await write(id, figure);
})().catch((error) => {
  console.error(String(error && error.stack || error));
  process.exit(1);
});
