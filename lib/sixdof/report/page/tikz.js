// Figures of lines and points as documents for LaTeX with PGFPlots: one file with the axes, and one with the numbers of
// each curve, which another program can read too.

"use strict";

(function (report) {
  // The marks of figure_spec.js in its order.
  const marks = { circle: "*", square: "square*", "triangle-up": "triangle*", diamond: "diamond*", cross: "+", "triangle-down": "triangle*",
                  "triangle-right": "triangle*", "triangle-left": "triangle*" };
  const turns = { "triangle-down": 180, "triangle-right": 270, "triangle-left": 90 };

  const special = { "\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}", "µ": "\\ensuremath{\\mu}", "≈": "\\ensuremath{\\approx}",
                    "–": "--", "<": "\\textless{}", ">": "\\textgreater{}", "\"": "''" };

  /** Text of results as text of LaTeX. Letters that few fonts of LaTeX have become question marks. */
  report.texText = (text) => String(text).replace(/[\\~^µ≈–<>"{}#$%&_]|[^\x20-\x7e]/g, (letter) => special[letter] ?? (letter < "\x7f" ? "\\" + letter : "?"));

  const isLine = (part) => part.mark?.type === "line" && part.encoding?.color !== null;
  const parts = (figure) => [figure, ...(figure.layer || [])].filter((part) => !part.data);

  /** Columns of a figure's axis and of the bounds of its intervals; nothing for an axis without a column. */
  function axisOf(figure, channel, rows, choices) {
    const encoding = report.encodingOf(figure, channel);
    if (!encoding) return null;
    const { floor, axes, value } = figure.usermeta;
    const field = encoding.field === "shown" ? floor : axes ? channel : encoding.field;
    const isText = encoding.type !== "quantitative";
    const given = isText ? report.valuesOf(rows, field) : [];
    const names = Array.isArray(encoding.sort) ? encoding.sort.filter((name) => given.includes(name)) : given;
    const bounds = value?.low && value.axis === channel && rows.some((row) => typeof row[value.low] === "number") ? [value.low, value.high] : null;
    const isLog = encoding.scale?.type === "log" && rows.every((row) => !(row[field] < 0));
    return { field, names, isText, isLog, bounds, title: encoding.title === null ? "" : report.axisTitle(figure, channel, choices) };
  }

  /** The smallest value above rounding, over 3: where a logarithmic axis has what is zero. */
  function placeOf(axis, rows) {
    if (axis.isText) return (row) => axis.names.indexOf(row[axis.field]);
    const least = Math.min(...rows.map((row) => row[axis.field]).filter((value) => value > report.rounding)) / 3;
    return (row) => (axis.isLog ? Math.max(row[axis.field], Number.isFinite(least) ? least : report.rounding) : row[axis.field]);
  }

  const shortName = (name) => String(name).replace(/algorithm:|pair:/g, "").slice(0, 40);
  const letterCm = 0.16;

  const isTooLong = (names, width) => Math.max(...names.map((name) => name.length)) * names.length * letterCm > width - 2;

  function axisOptions(axis, channel, rows, place, width, rules) {
    const title = report.linesOf(axis.title, Math.floor(0.7 * width / letterCm)).map(report.texText).join("\\\\");
    const options = [`${channel}label={${title}}`];
    if (axis.isText) options.push(`${channel}tick={${axis.names.map((name, i) => i).join(",")}}`, `${channel}ticklabels={${axis.names.map((name) => `{${report.texText(shortName(name))}}`).join(",")}}`);
    if (axis.isText && channel === "x" && isTooLong(axis.names, width)) options.push("x tick label style={font=\\small, rotate=35, anchor=east}");
    const values = [...rows.map(place), ...rules.filter((rule) => rule.channel === channel).map((rule) => rule.value)].filter((value) => value > 0 || !axis.isLog);
    if (rules.some((rule) => rule.channel === channel)) {
      const [low, high] = [Math.min(...values), Math.max(...values)];
      options.push(`${channel}min=${axis.isLog ? low / 1.5 : low - 0.1 * (high - low)}`, `${channel}max=${axis.isLog ? high * 1.5 : high + 0.1 * (high - low)}`);
    }
    if (axis.isLog) {
      // Values below rounding stand at the lower edge, whose tick says so.
      const floored = rows.filter((row) => row[axis.field] <= report.rounding).map(place).slice(0, 1);
      const ticks = report.logTicks(floored.length > 0 ? floored[0] * 1.5 : Math.min(...values) / 2, Math.max(...values) * 2);
      options.push(`${channel}mode=log`, `${channel}tick={${[...floored, ...ticks].join(",")}}`, `${channel}ticklabels={${[...floored.map(() => "$\\approx 0$"), ...ticks].join(",")}}`);
    }
    return options;
  }

  /** Lines across the figure, such as the deadline of a haptic loop: layers with a value of their own. */
  function rulesOf(figure) {
    return (figure.layer || []).filter((part) => part.data && part.mark?.type === "rule").flatMap((part) => {
      const channel = part.encoding.y ? "y" : "x";
      return part.data.values.map((values) => ({ channel, value: values[part.encoding[channel].field] }));
    });
  }

  function ruleText({ channel, value }, across) {
    const points = [Math.min(...across), Math.max(...across)].map((place) => (channel === "y" ? `(${place},${value})` : `(${value},${place})`));
    return `\\addplot[densely dashed, gray, no marks, forget plot] coordinates {${points.join(" ")}};`;
  }

  /** What tells curves of one algorithm apart: measured from ideal, ours from the paper's. */
  const curveColumn = (figure) => (["curve", "whose"].find((column) => parts(figure).some((part) => JSON.stringify(part).includes(`"${column}"`) || JSON.stringify(part).includes(`datum.${column}`))));

  const seconds = ["ideal", "the paper's"];  // dashed or hollow

  function curvesOf(figure, rows, algorithms) {
    const field = figure.usermeta.algorithm || "algorithm", column = curveColumn(figure);
    return report.legendOrder(figure, rows, algorithms).flatMap((name) => {
      const own = rows.filter((row) => row[field] === name);
      return (column ? report.valuesOf(own, column).sort((a, b) => seconds.includes(a) - seconds.includes(b)) : [null]).map((kind) => ({ name, kind, isSecond: seconds.includes(kind), rows: kind === null ? own : own.filter((row) => row[column] === kind) }));
    });
  }

  function plotOptions(curve, hasLine, algorithms, index) {
    const shape = report.shapeOf(report.styleOf(curve.name, algorithms)), { isSecond } = curve;
    const options = [`color=curve${index}`, `mark=${marks[shape]}`, "mark size=1.6pt"];
    const mark = [turns[shape] ? `rotate=${turns[shape]}` : "", isSecond ? "fill=none" : ""].filter(Boolean);
    if (mark.length > 0) options.push(`mark options={${mark.join(",")}}`);
    if (!hasLine) options.push("only marks");
    else if (isSecond || report.baseAlgorithm(curve.name) !== curve.name) options.push("dashed");
    if (curve.rows.length > 40) options.push("no marks");
    return options.join(", ");
  }

  const numberOf = (value) => (typeof value === "number" && Number.isFinite(value) ? String(value) : "nan");

  /** @returns pairs of name and text: nothing for a figure without two axes of numbers or names, or without algorithms
   * @param looks {algorithms, width (pixels), title ({text, subtitle} or nothing), font} */
  report.tikzFiles = function (id, figure, chosen, choices, looks) {
    const rows = report.drawnRows(figure, chosen), isDrawn = parts(figure).some((part) => isLine(part) || part.mark?.type === "point");
    const [x, y] = ["x", "y"].map((channel) => axisOf(figure, channel, rows, choices));
    if (!isDrawn || !x || !y || figure.usermeta.facet || rows.length === 0) return [];
    const hasLine = parts(figure).some(isLine), [placeX, placeY] = [placeOf(x, rows), placeOf(y, rows)];
    const curves = curvesOf(figure, rows, looks.algorithms), files = [], colours = [], plots = [];
    const bounded = [x, y].find((axis) => axis.bounds), direction = bounded === x ? "x" : "y";
    curves.forEach((curve, index) => {
      const name = `${id}-${index + 1}.dat`, place = bounded === x ? placeX : placeY;
      const ordered = hasLine ? [...curve.rows].sort((a, b) => placeX(a) - placeX(b)) : curve.rows;
      const lines = ordered.map((row) => {
        const bounds = bounded ? bounded.bounds.map((column, k) => (typeof row[column] === "number" ? Math.max(0, (k ? 1 : -1) * (row[column] - place(row))) : 0)) : [];
        return [placeX(row), placeY(row), ...bounds].map(numberOf).join(" ");
      });
      files.push([name, `# ${report.texText(curve.name)}${curve.kind === null ? "" : ", " + curve.kind}\nx y${bounded ? " minus plus" : ""}\n${lines.join("\n")}\n`]);
      colours.push(`\\definecolor{curve${index}}{HTML}{${report.colourOf(report.styleOf(curve.name, looks.algorithms), "light").slice(1).toUpperCase()}}`);
      const errors = bounded ? `, error bars/.cd, ${direction} dir=both, ${direction} explicit` : "";
      const columns = bounded ? `[x=x, y=y, ${direction} error plus=plus, ${direction} error minus=minus]` : "[x=x, y=y]";
      plots.push(`\\addplot[${plotOptions(curve, hasLine, looks.algorithms, index)}${errors}] table${columns} {${name}};`,
                 `\\addlegendentry{${report.texText(curve.kind === null ? curve.name : `${curve.name}, ${curve.kind}`)}}`);
    });
    const namesCm = y.isText ? letterCm * Math.max(...y.names.map((name) => shortName(name).length)) : 0;
    const width = (looks.width || 454) * 2.54 / 96, plotWidth = Math.max(4, width - namesCm);
    const rules = rulesOf(figure), isTurned = x.isText && isTooLong(x.names, width);
    const height = y.isText ? [`height=${(2.5 + 0.5 * y.names.length).toFixed(2)}cm`] : [];
    const columns = report.legendColumns(curves.map(({ name, kind }) => (kind === null ? name : `${name}, ${kind}`)), 96 / 2.54 * width, curves.length);
    const title = looks.title ? [`title={${report.texText(looks.title.text)}${looks.title.subtitle ? ": " + report.texText(looks.title.subtitle) : ""}}`, "title style={align=center, text width=0.9*\\pgfkeysvalueof{/pgfplots/width}}"] : [];
    const options = [`width=${plotWidth.toFixed(2)}cm`, ...height, ...title, ...axisOptions(x, "x", rows, placeX, width, rules), ...axisOptions(y, "y", rows, placeY, 0.75 * width, rules),
                     `legend style={at={(0.5,${isTurned ? -0.5 : -0.3})}, anchor=north, legend columns=${columns}, draw=none, font=\\small}`, "grid=major", "label style={font=\\small, align=center}", "tick label style={font=\\small}", "legend cell align=left"];
    if (y.isText) options.push("y dir=reverse");
    const font = looks.font ? `\\usepackage{fontspec} % needs LuaLaTeX or XeLaTeX\n\\setmainfont{${report.texText(looks.font)}}\n` : "";
    files.push([`${id}.tex`, `% ${id}: made by sixdof report --tikz. For a paper, take what stands between the lines "begin" and "end".\n` +
      `\\documentclass{article}\n\\usepackage{pgfplots}\n\\pgfplotsset{compat=1.16}\n${font}\\pagestyle{empty}\n\\begin{document}\n\\noindent\n% begin\n${colours.join("\n")}\n` +
      `\\begin{tikzpicture}\n\\begin{axis}[\n  ${options.join(",\n  ")}]\n${plots.join("\n")}\n${rules.map((rule) => ruleText(rule, rows.map(rule.channel === "y" ? placeX : placeY))).join("\n")}\n\\end{axis}\n\\end{tikzpicture}\n% end\n\\end{document}\n`]);
    return files;
  };
})(globalThis.sixdofReport);
