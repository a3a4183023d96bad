// The sentences under each figure against what the figure draws: values are read back from the places of the marks.
//   node figure_text_test.js REPORT_FOLDER DATA.json...
// Prints how many figures and choices it compared, and ends with 1 and a line for each difference.

"use strict";

const fs = require("fs");
const path = require("path");
const vm = require("vm");

const [folder, ...files] = process.argv.slice(2);
for (const file of ["vendor/vega.min.js", "vendor/vega-lite.min.js", "page/figure_spec.js", "page/figure_text.js"]) {
  vm.runInThisContext(fs.readFileSync(path.join(folder, file), "utf8"), { filename: file });
}
const report = globalThis.sixdofReport;

const failures = [], compared = {};
let where = "";
function check(isRight, words) {
  if (!isRight) failures.push(`${where}: ${words}`);
}
const isNear = (a, b) => Math.abs(a - b) <= 0.01 * Math.max(Math.abs(a), Math.abs(b)) + 1e-9;

/** Every mark of a kind, without those of legends and axes. */
function marksOf(view, kind) {
  const found = [];
  (function visit(item) {
    if (item.marktype === kind && item.role === "mark") found.push(...item.items);
    for (const child of item.items || []) visit(child);
  })(view.scenegraph().root);
  return found;
}

function axisTexts(view) {
  const found = [];
  (function visit(item) {
    if (item.role === "axis-title" || item.role === "legend-title") found.push(...item.items.map((each) => [each.text].flat().join(" ")));
    for (const child of item.items || []) visit(child);
  })(view.scenegraph().root);
  return found;
}

async function drawn(figure, rows, choices, algorithms, width = 700) {
  const spec = report.prepareSpec(figure, rows, choices, { theme: "light", algorithms, width, legend: true, linear: false });
  const view = new vega.View(vega.parse(vegaLite.compile(spec).spec), { renderer: "none" });
  await view.runAsync();
  return view;
}

const numberIn = (text, word) => {
  const found = new RegExp(`${word} (≈ 0|-?[\\d.,]+(?:e[-+]?\\d+)?)`).exec(text);
  return !found ? undefined : found[1] === "≈ 0" ? 0 : Number(found[1].replace(/,/g, ""));
};

/** Values of a figure's points as their places have them. */
function valuesOf(view, axis) {
  const scale = view.scale(axis);
  return marksOf(view, "symbol").map((item) => scale.invert(item[axis]));
}

function compareExtremes(figure, view, text, axis) {
  const values = valuesOf(view, axis), [low, high] = [Math.min(...values), Math.max(...values)];
  check(values.length > 0, "no point is drawn");
  for (const [word, value] of [["lowest", low], ["highest", high]]) {
    let said = numberIn(text, word);
    if (said === undefined) said = low === high || values.length === 1 ? numberIn(text, ":") : undefined;
    const floor = view.scale(axis).domain()[0];
    check(said !== undefined && (isNear(said, value) || (said === 0 && isNear(value, floor))), `says "${text}", but the ${word} mark is at ${value}`);
  }
  const title = text.slice(0, text.search(/: (highest|lowest|-?[\d≈])/));
  check(axisTexts(view).some((each) => each.toLowerCase() === title.toLowerCase()), `"${title}" is no title of an axis: ${axisTexts(view)}`);
}

function compareDifference(view, text) {
  const scale = view.scale("y"), curves = new Map();
  for (const item of marksOf(view, "line")) curves.set(`${item.datum.curve}/${item.datum.algorithm}/${item.x}`, scale.invert(item.y));
  const hasIdeal = [...curves.keys()].some((key) => key.startsWith("ideal"));  // an angle to the ideal has none beside it
  const differences = [...curves].filter(([key]) => key.startsWith("measured"))
    .map(([key, value]) => Math.abs(value - (hasIdeal ? curves.get(key.replace("measured", "ideal")) : 0))).filter(Number.isFinite);
  check(differences.length > 10, "no curves are drawn");
  check(isNear(numberIn(text, ":"), Math.max(...differences)), `says "${text}", but the largest distance is ${Math.max(...differences)}`);
}

function compareLevels(view, text) {
  const levels = marksOf(view, "rect").filter((item) => item.datum.frequency_hz > 40).map((item) => item.datum.level_db);
  check(isNear(numberIn(text, ":"), Math.max(...levels)), `says "${text}", but the loudest piece has ${Math.max(...levels)}`);
}

function compareVerdicts(view, text) {
  const count = {};
  for (const item of marksOf(view, "rect")) count[item.datum.class] = (count[item.datum.class] ?? 0) + 1;
  for (const [name, words] of [["exact", "exact"], ["within", "within the"], ["unsupported", "declared unsupported"], ["fault", "fault"]]) {
    check(text.includes(`${count[name] ?? 0} ${words}`), `says "${text}", but ${count[name] ?? 0} cells are ${name}`);
  }
}

/** Legend entries of algorithms stand as their lines do at the right end. */
function compareLegend(figure, view, rows, algorithms) {
  const field = figure.usermeta.algorithm || "algorithm", order = report.legendOrder(figure, report.drawnRows(figure, rows), algorithms);
  const lines = marksOf(view, "line").filter((item) => item.datum[field] !== undefined);
  const isOrdered = [figure, ...(figure.layer || [])].some((part) => part.mark?.type === "line" && part.encoding?.color !== null);
  if (!isOrdered || figure.usermeta.gaps) return;
  const ends = new Map();
  for (const item of lines) if (!(ends.get(item.datum[field])?.x > item.x)) ends.set(item.datum[field], item);
  const heights = order.map((name) => ends.get(name)?.y);
  check(heights.every((y, i) => i === 0 || y >= heights[i - 1] - 1e-6), `legend ${order} is not in the order of the lines, at ${heights}`);
}

/** Every algorithm has the colour and mark of its style in every figure. */
function compareStyles(figure, view, algorithms) {
  const field = figure.usermeta.algorithm || "algorithm";
  if (figure.usermeta.noChips) return;
  for (const item of marksOf(view, "symbol")) {
    const name = item.datum[field];
    if (name === undefined || item.stroke === "#c0392b") continue;
    const style = report.styleOf(name, algorithms), colours = [item.fill, item.stroke];
    check(colours.includes(report.colourOf(style, "light")), `${name} has ${colours}, not ${report.colourOf(style, "light")}`);
    check(item.shape === report.shapeOf(style), `${name} is a ${item.shape}, not a ${report.shapeOf(style)}`);
  }
}

function compareMissing(figure, texts, shown, all) {
  if (figure.usermeta.noChips || figure.usermeta.algorithm) return;
  const known = new Set(all.filter((row) => shown.choices.run === undefined || row.run === shown.choices.run).map((row) => report.baseAlgorithm(row.algorithm)));
  const present = new Set(shown.before.map((row) => report.baseAlgorithm(row.algorithm)));
  const absent = known.size - present.size, said = Number(/(\d+) algorithms? ha(?:s|ve) no row here/.exec(texts.missing)?.[1] ?? 0);
  check(said === absent, `says "${texts.missing}", but ${absent} algorithms are absent`);
  const faulty = report.drawnRows(figure, shown.rows).filter((row) => row.faults).length, count = Number(/(\d+) of \d+ drawn value/.exec(texts.missing)?.[1] ?? 0);
  check(count === faulty, `says "${texts.missing}", but ${faulty} drawn values have faults`);
}

/** Rows that could not be run are named under the figures of their query. */
function compareFailed(figure, texts, shown, data) {
  const { fails } = figure.usermeta, { pair, run, query } = shown.choices;
  if (!fails || !pair || pair === "all objects (mean)" || figure.usermeta.table !== "times" || shown.choices.percent !== undefined) return;
  const failed = report.rowsOf(data.tables.failures).filter((row) => row.fault.startsWith("not run") && row.run === run && row.query === query &&
                                                                     row.pair === pair && row.bucket.startsWith(fails.bucket));
  const said = Number(/(\d+) rows? failed/.exec(texts.missing)?.[1] ?? 0);
  check(said === failed.length && failed.every((row) => texts.missing.includes(row.algorithm)), `says "${texts.missing}", but ${failed.length} rows were not run`);
  if (failed.length > 0) compared.failed = (compared.failed ?? 0) + 1;
}

function compareAdvice(figure, texts, shown, data) {
  const rows = report.drawnRows(figure, shown.rows), { value, times } = figure.usermeta;
  const isOnce = rows.some((row) => row.repetitions < 3 && row.repetitions !== null);
  check(texts.advice.includes("fewer than 3 times") === isOnce, `says "${texts.advice}", but the least repetitions are ${Math.min(...rows.map((row) => row.repetitions))}`);
  const busy = data.runs.filter((run) => run.is_busy && (rows[0].run === undefined || rows.some((row) => row.run === run.name)));
  check(texts.advice.includes("did other work") === Boolean(times && busy.length > 0), `says "${texts.advice}", but ${busy.length} runs were on a busy machine`);
  const isWide = (row) => typeof row[value.low] === "number" && (row[value.high] - row[value.low]) / Math.abs(row[value.field]) > 0.25 && row.repetitions !== null;
  const wide = value?.low ? rows.filter(isWide).length : 0;
  check(Number(/\(95 %\), (\d+)/.exec(texts.advice)?.[1] ?? 0) === wide, `says "${texts.advice}", but ${wide} intervals are wide`);
  for (const [name, has] of [["once", isOnce], ["busy", times && busy.length > 0], ["wide", wide > 0]]) if (has) compared[name] = (compared[name] ?? 0) + 1;
}

async function compare(id, figure, data, wanted) {
  const all = report.figureRows(figure, data.tables), { facet, value } = figure.usermeta;
  const { resolved, choices, rows: before } = report.resolveChoices(figure, all, wanted, data.metrics);
  const rows = report.withAxes(figure, before, choices, data.metrics);
  where = `${id} ${JSON.stringify(wanted)}`;
  if (rows.length > 0) {
    const shown = { choices, before, rows }, texts = report.figureTexts(figure, shown, all, data);
    const view = await drawn(figure, rows, choices, data.algorithms);
    if (!value) compareVerdicts(view, texts.finding);
    else if (value.against) compareDifference(view, texts.finding);
    else if (facet) compareLevels(view, texts.finding);
    else compareExtremes(figure, view, texts.finding, value.axis);
    compareMissing(figure, texts, shown, all);
    compareFailed(figure, texts, shown, data);
    compareAdvice(figure, texts, shown, data);
    compareLegend(figure, view, rows, data.algorithms);
    compareStyles(figure, view, data.algorithms);
    view.finalize();
    compared[id] = (compared[id] ?? 0) + 1;
  }
  return resolved;
}

(async () => {
  for (const file of files) {
    const data = report.unpack(JSON.parse(fs.readFileSync(file, "utf8")));
    for (const [id, figure] of Object.entries(data.figures)) {
      const resolved = await compare(id, figure, data, {});
      for (const { filter, values } of resolved) for (const choice of values.slice(0, 5)) await compare(id, figure, data, { [filter.field]: choice });
    }
    const names = Object.keys(data.figures).filter((id) => !data.tables[data.figures[id].usermeta.table] && !compared[id]);
    console.log(JSON.stringify({ file: path.basename(file), compared, without: names }));
  }
  const marks = report.shapes.map((shape, i) => `${report.shapeOf(i)}`);
  where = "styles";
  check(new Set(marks).size === 8, `eight marks, but ${marks}`);
  check(new Set(report.known.map((name) => report.colourOf(report.styleOf(name, []), "light") + report.shapeOf(report.styleOf(name, [])))).size === report.known.length, "two algorithms look alike");
  for (const failure of failures.slice(0, 40)) console.error(failure);
  process.exit(failures.length > 0 ? 1 : 0);
})();
