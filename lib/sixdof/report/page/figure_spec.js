// From a figure's data file, the tables and a reader's choices to a Vega-Lite specification that can be drawn. No page
// is needed here: page/write_figures.js does the same under node.

"use strict";

var sixdofReport = globalThis.sixdofReport || {};
globalThis.sixdofReport = sixdofReport;

// Okabe and Ito's colours, told apart by colour-blind readers, and four more; the second set is for a dark background.
sixdofReport.palettes = {
  light: ["#0072b2", "#d55e00", "#009e73", "#aa4499", "#b8860b", "#56b4e9", "#444444", "#7b3294", "#7f3f1d", "#b2182b", "#6b8e23", "#0f6b75"],
  dark: ["#4ea3e0", "#ff8c42", "#2fd3a3", "#e28ad0", "#f0c419", "#8fd3ff", "#d0d0d0", "#b794f6", "#c98a5e", "#ff6b6b", "#b5d36a", "#5cc5cf"],
};
sixdofReport.shapes = ["circle", "square", "triangle-up", "diamond", "cross", "triangle-down", "triangle-right", "triangle-left"];
// These have the same colour and shape in every report. The first twelve differ in colour, the first eight in both; no two of all have both in common.
sixdofReport.known = ["exact", "vps", "ist", "fcl-contacts", "bullet-gimpact", "ode", "vps-field", "ist-descent",
                      "fcl-rss", "fcl-obbrss", "fcl-kios", "gts", "fcl-obb", "fcl-aabb", "embree", "simbody", "ccd-hull",
                      "mujoco-hull"];

/** Number of an algorithm's colour and shape, among the algorithms of a report. */
sixdofReport.styleOf = function (name, algorithms) {
  const family = sixdofReport.familyOf(name), known = sixdofReport.known;
  if (known.includes(family)) return known.indexOf(family);
  const others = [...new Set(algorithms.map(sixdofReport.familyOf))].filter((each) => !known.includes(each));
  return known.length + Math.max(0, others.indexOf(family));
};
sixdofReport.colourOf = function (style, theme) {
  const palette = sixdofReport.palettes[theme];
  return palette[style % palette.length];
};
sixdofReport.shapeOf = function (style) {
  const shapes = sixdofReport.shapes;
  return shapes[(style + Math.floor(style / sixdofReport.palettes.light.length)) % shapes.length];
};

/** Puts texts back in the place of their indices (page.cpp). */
sixdofReport.unpack = function (data) {
  for (const table of Object.values(data.tables)) {
    const texts = table.columns.map((column) => table.texts[column]);
    for (const row of table.rows) {
      texts.forEach((list, i) => { if (list && row[i] !== null) row[i] = list[row[i]]; });
    }
  }
  return data;
};

/** Rows of a table as objects. */
sixdofReport.rowsOf = function (table) {
  return table.rows.map((cells) => Object.fromEntries(table.columns.map((column, i) => [column, cells[i]])));
};

/** "vps (cold)" has the colour of "vps", and a dashed line. */
sixdofReport.baseAlgorithm = function (name) {
  return String(name).replace(/ \((?:path order|motion|cold)\)$/, "");
};

/** "vps@point_spacing=0.004", "vps (728x24x303, 15,669)" and "vps (cold)" have the colour of "vps". */
sixdofReport.familyOf = function (name) {
  return String(name).replace(/ \(.*$/, "").replace(/@.*$/, "");
};

/** Of the names of a legend, which one it is of its family, from 0: resolutions of one algorithm differ in dashes and
 * marks. */
sixdofReport.resolutionsOf = function (names) {
  const base = (name) => sixdofReport.baseAlgorithm(name), families = new Map();
  for (const name of [...new Set(names.map(base))].sort((a, b) => a.localeCompare(b, "en", { numeric: true }))) {
    const family = sixdofReport.familyOf(name);
    families.set(family, [...(families.get(family) ?? []), name]);
  }
  return names.map((name) => families.get(sixdofReport.familyOf(name)).indexOf(base(name)));
};

/** The rows of a figure before any choice, with the columns that it scales; a row for each of the columns that it folds. */
sixdofReport.figureRows = function (figure, tables) {
  const table = tables[figure.usermeta.table];
  const { where = {}, need = [], scaled = {}, fold } = figure.usermeta;
  if (!table) return [];
  const rows = sixdofReport.rowsOf(table).filter((row) => Object.entries(where).every(([key, value]) => row[key] === value) &&
                                                          need.every((column) => row[column] !== null));
  for (const [column, { of, by }] of Object.entries(scaled)) for (const row of rows) row[column] = row[of] * by;
  if (!fold) return rows;
  return rows.flatMap((row) => Object.entries(fold.columns).filter(([, column]) => row[column] !== null)
    .map(([name, column]) => ({ ...row, [fold.as[0]]: name, [fold.as[1]]: row[column] })));
};

/** What a figure says of a channel, in itself or in the first of its layers that is about its rows and has a title. */
sixdofReport.encodingOf = function (figure, channel) {
  const layers = (figure.layer || []).filter((layer) => !layer.data);
  const encodings = [figure, ...layers].map((part) => part.encoding?.[channel]).filter((encoding) => encoding?.field);
  return encodings.find((encoding) => encoding.title !== undefined) ?? encodings[0];
};

/** Of the rows of all choices those that a figure draws, in its order. */
sixdofReport.drawnRows = function (figure, rows) {
  const { value, largest, order } = figure.usermeta;
  let drawn = value && !figure.usermeta.gaps ? rows.filter((row) => typeof row[value.field] === "number") : rows;
  if (largest) drawn = largestOf(drawn, largest);
  if (order) drawn = [...drawn].sort((a, b) => (b[order] ?? 0) - (a[order] ?? 0));
  return drawn;
};

/** Algorithms in the order of a legend: where a figure has lines, from top to bottom at their right ends; elsewhere the
 * same in every report. */
sixdofReport.legendOrder = function (figure, rows, algorithms) {
  const field = figure.usermeta.algorithm || "algorithm", x = sixdofReport.encodingOf(figure, "x"), y = sixdofReport.encodingOf(figure, "y");
  const names = [...new Set(rows.map((row) => row[field]))];
  const fixed = (a, b) => sixdofReport.styleOf(a, algorithms) - sixdofReport.styleOf(b, algorithms);
  const hasLines = [figure, ...(figure.layer || [])].some((part) => part.mark?.type === "line" && part.encoding?.color !== null);
  if (!hasLines || !x || !y) return names.sort(fixed);
  const column = y.field === "shown" ? figure.usermeta.floor : y.field, place = (row) => (x.sort ? x.sort.indexOf(row[x.field]) : row[x.field]);
  const ends = new Map();
  for (const row of rows) {
    if (typeof row[column] === "number" && !(place(ends.get(row[field]) ?? row) > place(row))) ends.set(row[field], row);
  }
  const end = (name) => ends.get(name)?.[column] ?? -Infinity;
  return names.sort((a, b) => end(b) - end(a) || fixed(a, b));
};

/** Values from which a reader chooses, of a filter under the choices of the filters before it. */
sixdofReport.valuesOf = function (rows, field) {
  return [...new Set(rows.map((row) => row[field]).filter((value) => value !== null && value !== ""))];
};

/** Title of a figure in a file: what is chosen stands below; the name of the run only where there are several. */
sixdofReport.titleOf = function (figure, choices, facet, all) {
  const { title, filters = [] } = figure.usermeta, fields = filters.map((filter) => filter.field);
  const words = ({ field }) => {
    if (field === "run" && sixdofReport.valuesOf(all, "run").length < 2) return undefined;
    if (field === "bucket" && fields.includes("percent")) return undefined;
    return field === "percent" ? `${choices.bucket} ${choices.percent} %` : choices[field];
  };
  const said = filters.map(words).filter((text) => text !== undefined && text !== "all");
  return { text: title, subtitle: [...said, ...(facet === null ? [] : [facet])].join(", ") };
};

/** Completes choices: each filter offers what is left by those before it, each axis the metrics that differ in what is
 * left then. Returns what each offers and what is chosen, all choices by field, and the rows that are left. */
sixdofReport.resolveChoices = function (figure, rows, wanted, metrics) {
  const resolved = [];
  const { gaps } = figure.usermeta;
  const hasValue = (row) => gaps === undefined || row[gaps] !== null;
  let left = rows;
  const choose = (filter, values) => {
    let value = values.find((each) => String(each) === String(wanted[filter.field]));
    const preferred = filter.prefer ? sixdofReport.valuesOf(left.filter((row) => row[filter.prefer.column] === filter.prefer.value), filter.field) : [];
    if (value === undefined) value = [...preferred, filter.default].flat().find((each) => values.includes(each)) ?? values[0];
    resolved.push({ filter, values, value });
    return value;
  };
  for (const filter of figure.usermeta.filters || []) {
    const values = sixdofReport.valuesOf(left.filter(hasValue), filter.field);
    if (filter.all) values.unshift("all");
    const value = choose(filter, values);
    if (value !== undefined && value !== "all") left = left.filter((row) => row[filter.field] === value);
  }
  for (const axis of figure.usermeta.axes || []) {
    choose({ ...axis, names: (name) => `${name}: ${metrics[name].meaning}` }, metricsOf(left, metrics));
  }
  const choices = Object.fromEntries(resolved.map(({ filter, value }) => [filter.field, value]));
  for (const axis of figure.usermeta.axes || []) choices[axis.field + "_title"] = titleOfMetric(choices[axis.field], metrics);
  return { resolved, choices, rows: left };
};

/** Metrics of which the rows have two values or more. */
function metricsOf(rows, metrics) {
  return Object.keys(metrics).filter((name) => new Set(rows.map((row) => row[name]).filter((value) => typeof value === "number")).size > 1);
}

function titleOfMetric(name, metrics) {
  if (!name) return "";
  const { meaning, unit } = metrics[name];
  return unit === "1" ? meaning : `${meaning}, ${unit}`;
}

/** Lines of whole words. @param longest letters of a line */
sixdofReport.linesOf = function (text, longest) {
  const lines = [""];
  for (const word of text.split(" ")) {
    if (lines.at(-1) && lines.at(-1).length + 1 + word.length > longest) lines.push(word);
    else lines[lines.length - 1] += (lines.at(-1) ? " " : "") + word;
  }
  return lines;
};

/** Gives rows of a figure with free axes their x and y; of the metrics they keep these two. */
sixdofReport.withAxes = function (figure, rows, choices, metrics) {
  if (!figure.usermeta.axes) return rows;
  const names = figure.usermeta.axes.map((axis) => choices[axis.field]);
  if (names.some((name) => name === undefined)) return [];
  const isKept = ([column]) => !metrics[column] || names.includes(column);
  return rows.filter((row) => names.every((name) => typeof row[name] === "number")).map((row) => (
    { ...Object.fromEntries(Object.entries(row).filter(isKept)), x: row[names[0]], y: row[names[1]] }));
};

/** Rows with the value by which the worst is found: as they are or, with `against`, the difference from the row of the
 * other curve at the same place. */
sixdofReport.ratedRows = function (rows, { field, against }) {
  if (!against || !rows.some((row) => row[against.column] === against.value)) return rows;
  const key = (row) => JSON.stringify(against.same.map((column) => row[column]));
  const other = new Map(rows.filter((row) => row[against.column] === against.value).map((row) => [key(row), row[field]]));
  return rows.filter((row) => row[against.column] !== against.value && other.has(key(row))).map((row) => ({ ...row, [field]: row[field] - other.get(key(row)) }));
};

/** Errors below this are rounding: they would stretch a logarithmic axis over ten decades. */
sixdofReport.rounding = 1e-9;

/** Smallest value that is drawn in its place, over 3. */
function floorOf(rows, field) {
  const values = rows.map((row) => row[field]).filter((value) => value > sixdofReport.rounding);
  return values.length ? Math.min(...values) / 3 : sixdofReport.rounding;
}

/** 1, 2 and 5 times the powers of ten between two numbers; powers alone where there are many. */
sixdofReport.logTicks = function (from, to) {
  const decades = Math.log10(to / from), ticks = [];
  for (let power = Math.floor(Math.log10(from)); power <= Math.ceil(Math.log10(to)); ++power) {
    for (const factor of decades > 4 ? [1] : [1, 2, 5]) ticks.push(Number(`${factor}e${power}`));
  }
  return ticks.filter((tick) => tick >= from && tick <= to);
};

/** Gives every row its place `shown` on the axis `channel`, and the ends of its interval, the columns `bounds`, the places
 * `shown`_low and `shown`_high; values below rounding share the lower edge, whose tick says so. An axis with values below
 * zero is linear. */
function withFloor(spec, rows, { field, shown, channel, include = 0, bounds = [] }, linear) {
  const isSigned = rows.some((row) => row[field] < 0);
  const ends = (row, place) => Object.fromEntries(bounds.map((column, k) => [shown + ["_low", "_high"][k], typeof row[column] === "number" ? place(row[column]) : null]));
  if (linear || isSigned) {
    if (isSigned) visit(spec, (node) => { if (node[channel]?.field === shown) node[channel].scale = { type: "linear" }; });
    return rows.map((row) => ({ ...row, [shown]: row[field], ...ends(row, (value) => value) }));
  }
  const highest = (row) => Math.max(row[field] ?? 0, ...bounds.map((column) => row[column] ?? 0));
  const floor = floorOf(rows, field), top = Math.max(floor * 10, include, ...rows.map(highest)) * 1.1;
  const isFloored = rows.some((row) => row[field] !== null && row[field] <= sixdofReport.rounding);
  const low = isFloored ? floor : floor * 2.4;
  const label = "datum.value >= 1e6 ? format(datum.value, '~s') : datum.value >= 1e4 ? format(datum.value, ',') : format(datum.value, '~g')";
  visit(spec, (node) => {
    if (!node[channel] || node[channel].field !== shown) return;
    node[channel].scale = { type: "log", domain: [low, top], nice: false };
    node[channel].axis = { values: [...(isFloored ? [floor] : []), ...sixdofReport.logTicks(isFloored ? floor * 1.5 : low, top)],
                    labelExpr: isFloored ? `datum.value < ${floor * 1.01} ? '≈ 0' : ${label}` : label };
  });
  return rows.map((row) => ({ ...row, [shown]: row[field] === null ? null : Math.max(row[field], floor), ...ends(row, (value) => Math.max(value, low)) }));
}

function largestOf(rows, { by, count }) {
  const size = (row) => Math.abs(Math.log(row[by]));
  return [...rows].sort((a, b) => size(b) - size(a)).slice(0, count);
}

/** Visits every object of a specification. */
function visit(node, f) {
  if (node === null || typeof node !== "object") return;
  f(node);
  for (const value of Object.values(node)) visit(value, f);
}

function paintAlgorithms(spec, field, algorithms, context) {
  const styles = algorithms.map((name) => sixdofReport.styleOf(name, context.algorithms));
  const colours = styles.map((style) => sixdofReport.colourOf(style, context.theme));
  const places = sixdofReport.resolutionsOf(algorithms), patterns = [[1, 0], [8, 3], [2, 3], [8, 3, 2, 3]];
  const shapes = styles.map((style, i) => sixdofReport.shapeOf(style + 3 * places[i]));
  const dashes = algorithms.map((name, i) => (sixdofReport.baseAlgorithm(name) === name ? patterns[places[i] % patterns.length] : [6, 4]));
  visit(spec, (node) => {
    for (const [channel, range] of [["color", colours], ["fill", colours], ["shape", shapes], ["strokeDash", dashes]]) {
      const encoding = node[channel];
      if (!encoding || typeof encoding !== "object" || encoding.field !== field) continue;
      encoding.scale = { domain: algorithms, range };
      if (!context.legend) encoding.legend = null;
    }
  });
}

function useLinearAxes(spec, axes) {
  visit(spec, (node) => {
    for (const axis of axes) {
      if (node[axis] && node[axis].scale && node[axis].scale.type === "log") node[axis].scale = { type: "linear" };
    }
  });
}

sixdofReport.themes = {
  light: { text: "#1d2733", quiet: "#5b6775", grid: "#e6eaee", background: "#ffffff" },
  dark: { text: "#e8edf2", quiet: "#a7b3c0", grid: "#2c3742", background: "#161d24" },
};

/** Space for a letter of the usual size, in pixels. */
const letterWidth = 6.6;

/** Of a label of a legend, in pixels, before it is cut. */
const longestLabel = 400;

function configOf(theme, font) {
  const { text, quiet, grid, background } = sixdofReport.themes[theme];
  return {
    background,
    font: font || "system-ui, sans-serif",
    view: { stroke: grid },
    axis: { labelColor: text, titleColor: text, gridColor: grid, domainColor: quiet, tickColor: quiet, labelFontSize: 12,
            titleFontSize: 13, titleFontWeight: "normal" },
    legend: { labelColor: text, titleColor: text, labelFontSize: 12, symbolSize: 90, symbolOpacity: 1, orient: "bottom", labelLimit: longestLabel },
    header: { labelColor: text, titleColor: text },
    title: { color: text, fontSize: 14, subtitleColor: quiet, anchor: "start", frame: "bounds" },
    text: { color: text, fontSize: 12 },
  };
}

/** As many columns of a legend as fit beside the scale of the y axis. Under node Vega reckons 0.8 of the font's size for a
 * letter. */
sixdofReport.legendColumns = function (names, width, most) {
  const longest = Math.max(...names.map((name) => String(name).length), 1);
  return Math.max(1, Math.min(most, Math.floor((width - 80) / (Math.min(longestLabel, longest * 0.8 * 12) + 34))));
};

/** Names below an axis that has no room for them beside each other are turned; those at its side are cut. */
function fitNames(spec, rows, width) {
  visit(spec, (node) => {
    const { x, y } = node;
    if (x?.field && x.type === "nominal" && x.axis?.labelAngle === 0) {
      const names = sixdofReport.valuesOf(rows, x.field).map((name) => String(name).length);
      if (Math.max(...names) * names.length * letterWidth > width - 80) x.axis = { ...x.axis, labelAngle: -35 };
    }
    if (y?.field && y.type === "nominal") y.axis = { ...y.axis, labelLimit: Math.round(Math.min(y.axis?.labelLimit ?? 180, 0.4 * width)) };
  });
}

/** In cells that are too narrow for words, colours tell the verdicts. */
function shortenWords(spec, rows, cells, width) {
  const narrowest = 44, names = sixdofReport.valuesOf(rows, cells.field).length;
  if ((width - 120) / names < narrowest) spec.transform.push({ calculate: "datum.class == 'fault' ? '×' : ''", as: "word" });
}

/** Breaks titles that are longer than their axis. */
function breakTitles(spec, width, height) {
  visit(spec, (node) => {
    for (const [channel, room] of [["x", width], ["y", height]]) {
      const title = node[channel]?.title;
      if (typeof title === "string" || Array.isArray(title)) node[channel].title = sixdofReport.linesOf([title].flat().join(" "), Math.max(12, Math.floor(room / letterWidth)));
    }
  });
}

/**
 * @param figure a file of figures/
 * @param chosen rows, already filtered by all choices
 * @param choices value by field
 * @param context {theme, algorithms (all of the report, in order), width (a number or "container"), legend (boolean),
 *                 linear (boolean), title (text or nothing), font (nothing for the page's), room (width in pixels, of a
 *                 container)}
 */
sixdofReport.prepareSpec = function (figure, chosen, choices, context) {
  const spec = JSON.parse(JSON.stringify(figure));
  const meta = spec.usermeta;
  delete spec.usermeta;
  let rows = sixdofReport.drawnRows(figure, chosen);
  const algorithms = sixdofReport.legendOrder(figure, rows, context.algorithms);
  if (meta.floor) rows = withFloor(spec, rows, { field: meta.floor, shown: "shown", channel: "y", include: meta.include, bounds: meta.value?.low ? [meta.value.low, meta.value.high] : [] }, context.linear);
  if (meta.axes) {
    for (const channel of ["x", "y"]) rows = withFloor(spec, rows, { field: channel, shown: "shown_" + channel, channel }, context.linear);
  }
  // A layer without a value would leave its axis without an extent.
  const layers = spec.layer?.filter(({ needs }) => !needs || rows.some((row) => typeof row[needs] === "number"));
  if (layers) spec.layer = layers.map(({ needs, ...layer }) => layer);
  paintAlgorithms(spec, meta.algorithm || "algorithm", algorithms, context);
  if (context.linear) useLinearAxes(spec, meta.logAxes || []);
  visit(spec, (node) => {
    if (!node.title || !node.title.from) return;
    const title = choices[node.title.from] ?? node.title.from;
    node.title = Array.isArray(title) ? title : String(title);
  });
  const width = typeof context.width === "number" ? context.width : context.room || 900;
  spec.data = { values: rows };
  spec.width = context.width;
  // A figure with a row per name grows with the names; the others have one height, and less where they are narrow.
  const names = meta.rows ? new Set(rows.map((row) => row[meta.rows])).size : 0;
  spec.height = meta.rows ? Math.max(60, (meta.rowHeight || 24) * names) : meta.height || Math.round(Math.min(340, Math.max(190, 0.65 * width)));
  spec.autosize = { type: "fit-x", contains: "padding" };
  breakTitles(spec, meta.rows ? 0.55 * width : width - 80, spec.height);
  fitNames(spec, rows, width);
  if (meta.cells && typeof context.width === "number") shortenWords(spec, rows, meta.cells, width);
  if (context.title) spec.title = context.title;
  spec.config = configOf(context.theme, context.font);
  spec.config.legend.columns = sixdofReport.legendColumns(meta.noChips ? ["no change shown"] : algorithms, width, meta.noChips ? 4 : algorithms.length);
  return spec;
};
