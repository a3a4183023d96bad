// Draws every figure that has data as a file, at the choices that the data name under "choices" and at the default of
// all others.
//   node write_figures.js REPORT_FOLDER DATA.json OUTPUT_FOLDER [LOOKS]
// REPORT_FOLDER has page/ and vendor/. LOOKS is JSON: {"format": "svg" or "tikz", "width": pixels, "written": the width
// as a file has it ("84mm"), "font": family, "title": whether there is one}. Prints the name of every file that it
// wrote. Ends with 3 and a line of why where no figure offers a choice.

"use strict";

const fs = require("fs");
const path = require("path");
const vm = require("vm");

const [folder, dataFile, output, looksText] = process.argv.slice(2);
const looks = { format: "svg", title: true, ...JSON.parse(looksText || "{}") };
const load = (file) => vm.runInThisContext(fs.readFileSync(path.join(folder, file), "utf8"), { filename: file });
// Under node, Vega's file would be a module; as a script of a page it sets a global.
const scripts = ["page/figure_spec.js", "page/figure_text.js", "page/tikz.js"];
for (const file of ["vendor/vega.min.js", "vendor/vega-lite.min.js", ...scripts]) load(file);

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

/** A title in lines that a width has room for. */
function brokenTitle({ text, subtitle }, width) {
  return { text: report.linesOf(text, Math.floor(width / 9)), subtitle: subtitle ? report.linesOf(subtitle, Math.floor(width / 7)) : "" };
}

async function svgOf(figure, rows, choices, facet, all) {
  const width = looks.width || 640;
  const title = looks.title ? brokenTitle(report.titleOf(figure, choices, facet, all), width) : undefined;
  const spec = report.prepareSpec(figure, rows, choices, { theme: "light", algorithms: data.algorithms, width, room: width, legend: true,
                                                           linear: false, title, font: looks.font });
  const view = new vega.View(vega.parse(vegaLite.compile(spec).spec), { renderer: "none" });
  const svg = await view.toSVG();
  view.finalize();
  return looks.width ? report.withWidth(svg, looks.width, looks.written) : svg;
}

/** A drawing whose root has a width in the unit that was asked for, and the height that belongs to it. */
report.withWidth = function (svg, width, written) {
  return svg.replace(/^(<svg[^>]*?) width="([\d.]+)" height="([\d.]+)" viewBox="0 0 ([\d.]+) ([\d.]+)"/, (all, head, w, h, x, y) => {
    const unit = written.replace(/[\d.]+/, ""), height = Number(written.slice(0, -unit.length)) * y / x;
    return `${head} width="${written}" height="${Number(height.toFixed(3))}${unit}" viewBox="0 0 ${x} ${y}"`;
  });
};

function save(name, text) {
  fs.writeFileSync(path.join(output, name), text);
  console.log(name);
}

async function write(id, figure) {
  const { facet: column } = figure.usermeta, all = report.figureRows(figure, data.tables);
  const { choices, rows: chosen } = report.resolveChoices(figure, all, data.choices, data.metrics);
  const rows = report.withAxes(figure, chosen, choices, data.metrics);
  if (rows.length === 0) return;
  if (looks.format === "tikz") {
    const title = looks.title ? report.titleOf(figure, choices, null, all) : undefined;
    for (const [name, text] of report.tikzFiles(id, figure, rows, choices, { ...looks, algorithms: data.algorithms, title })) save(name, text);
    return;
  }
  for (const facet of column ? report.valuesOf(rows, column) : [null]) {
    const part = facet === null ? rows : rows.filter((row) => row[column] === facet);
    const name = facet === null ? `${id}.svg` : `${id}-${String(facet).replace(/[^A-Za-z0-9-]/g, "_")}.svg`;
    save(name, await svgOf(figure, part, choices, facet, all));
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
