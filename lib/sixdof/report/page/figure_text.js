// The sentences under a figure, from the rows that it draws: the extreme values in the unit of its axis, what is not
// drawn and why, and how far its numbers can be trusted. No page is needed here.

"use strict";

(function (report) {
  /** An interval wider than this share of its value says little. */
  const wideShare = 0.25;

  /** Repetitions from which an interval is estimated (results/estimate.h). */
  const fewestRepetitions = 3;

  const mostNames = 6, mostFailures = 3;

  report.numberText = (value) => (value !== 0 && Math.abs(value) < 1e-6 ? value.toExponential(2)
    : value.toLocaleString("en", { maximumSignificantDigits: 3 }));

  const valueText = (value, hasFloor) => (hasFloor && Math.abs(value) <= report.rounding ? "≈ 0" : report.numberText(value));

  function listText(names, most) {
    const shown = names.slice(0, most);
    return shown.join(", ") + (names.length > most ? ` and ${names.length - most} more` : "");
  }

  const countText = (count, one, many = one + "s") => `${count.toLocaleString("en")} ${count === 1 ? one : many}`;

  const texts = ["pair", "object", "shape", "scenario", "scene", "family", "component", "point", "statistic", "whose"];
  const numbers = { percent: (x) => `${x} %`, bodies: (x) => `${x} bodies`, triangles: (x) => `${x.toLocaleString("en")} triangles`,
                    time_ms: (x) => `at ${x} ms`, frequency_hz: (x) => `${x} Hz`, number: (x) => `run ${x}` };

  /** "vps, bunny, 5 %": what tells a row from the others that are drawn. */
  report.rowText = function (row, rows, meta) {
    const field = meta.algorithm || "algorithm";
    const parts = meta.noChips ? [row.row ?? row[field]] : [row[field]];
    const varies = (column) => rows.some((each) => each[column] !== row[column]);
    for (const column of texts) if (row[column] && varies(column) && column !== field) parts.push(row[column]);
    if (rows.some((each) => each[field] === row[field] && row.settings && each.settings && each.settings !== row.settings)) parts.push(row.settings);
    for (const [column, words] of Object.entries(numbers)) if (typeof row[column] === "number" && varies(column)) parts.push(words(row[column]));
    if (row.bucket && row.percent === undefined && varies("bucket")) parts.push(row.bucket);
    return parts.join(", ");
  };

  /** Title of a figure's axis, in one line. */
  report.axisTitle = function (figure, axis, choices) {
    const title = report.encodingOf(figure, axis)?.title ?? axis;
    const chosen = title.from ? choices[title.from] ?? title.from : title;
    return [chosen].flat().join(" ");
  };

  /** The rows from the worst on, and a sentence with the extreme values. Nothing for no rows. */
  function finding(figure, rows, choices) {
    const { value, floor } = figure.usermeta;
    const rated = report.ratedRows(rows, value).filter((row) => Number.isFinite(row[value.field]) && (!value.above || row[value.above.column] > value.above.than));
    if (rated.length === 0) return null;
    const size = (row) => (value.against ? Math.abs(row[value.field]) : row[value.field]);
    const falling = [...rated].sort((a, b) => size(b) - size(a)), rising = [...rated].sort((a, b) => size(a) - size(b)), [high] = falling, [low] = rising;
    const text = (row) => `${valueText(size(row), floor || figure.usermeta.axes)} (${report.rowText(row, rows, figure.usermeta)})`;
    const title = report.axisTitle(figure, value.axis, choices).replace(/^./, (letter) => letter.toUpperCase());
    if (value.label) return { ranked: falling, text: `${value.label}: ${text(high)}.` };
    if (rated.length === 1) return { ranked: falling, text: `${title}: ${text(high)}.` };
    if (value.worst === "low") return { ranked: rising, text: `${title}: lowest ${text(low)}, highest ${text(high)}.` };
    return { ranked: falling, text: `${title}: highest ${text(high)}, lowest ${text(low)}.` };
  }

  /** The same of a figure of verdicts. */
  function verdicts(figure, rows) {
    const kind = (verdict) => (verdict === "exact" ? "exact" : verdict.startsWith("within") ? "within" : verdict.startsWith("declared") ? "unsupported" : "fault");
    const count = { exact: 0, within: 0, unsupported: 0, fault: 0 };
    for (const row of rows) ++count[kind(row.verdict)];
    const worst = rows.filter((row) => kind(row.verdict) === "fault");
    const faults = worst.map((row) => `${row.algorithm} in ${row.family} (${row.verdict})`);
    return { ranked: worst, text: `Of ${countText(rows.length, "cell")}: ${count.exact} exact, ${count.within} within the declared resolution, ` +
      `${count.unsupported} declared unsupported, ${countText(count.fault, "fault")}${faults.length ? ": " + listText(faults, mostFailures) : ""}.` };
  }

  const isAll = (pair) => pair === undefined || pair === "all" || pair.startsWith("all objects (mean)");
  /** Why rows of a pair stand apart: "convex_hull", "python", "convex_hull, wasm"; "" for most (class_of() in results/row.h). */
  const apartOf = (pair) => / \(((?:convex_hull|python|node|wasm)[^()]*)\)$/.exec(pair)?.[1] ?? "";
  /** As the table of winners says it (body_words() in summary.cpp). */
  const bodyOf = (pair) => {
    const body = apartOf(pair).startsWith("convex_hull") ? "convex hulls" : "meshes", interpreter = apartOf(pair).replace(/^convex_hull(, )?/, "");
    return interpreter ? `${body} (${interpreter})` : body;
  };
  /** Means over all objects are of one class of rows. */
  const isOfPair = (pair, wanted) => !wanted || wanted === "all" || pair === wanted || (isAll(wanted) && apartOf(pair) === apartOf(wanted));
  const percentOf = (row) => row.percent ?? Number(/ (\S+) %$/.exec(row.bucket ?? "")?.[1]);

  /** What a row of the table of failures has in common with the row of a figure that would stand for it, if it had not failed. */
  const keys = {
    place: (row, ofAll) => [row.algorithm, ofAll ? "" : row.pair, percentOf(row)].join("/"),
    name: (row) => row.algorithm,
    base: (row) => report.baseAlgorithm(row.algorithm),
    scenario: (row) => [row.algorithm, row.scenario ?? row.scene ?? row.bucket].join("/"),
  };

  /** Whether a row of the table of failures is about what a reader chose. */
  function isAbout(row, wanted, fails) {
    const pair = row.pair ?? "", bucket = row.bucket ?? "", query = fails.query ?? wanted.query, order = row.algorithm.slice(report.baseAlgorithm(row.algorithm).length);
    const isOf = (column, value) => wanted[column] === undefined || wanted[column] === value;
    const isStudy = row.query === "precision" && wanted.measured === `${row.question}, every resolution`;
    return isOf("run", row.run) && (query === undefined || row.query === query) && isOfPair(pair, wanted.pair) &&
      (!wanted.bucket || bucket.startsWith(wanted.bucket)) && (!fails.bucket || bucket.startsWith(fails.bucket)) && isOf("percent", percentOf(row)) &&
      isOf("scenario", bucket) && isOf("scene", bucket) && isOf("question", row.question) &&
      isOf("where", [pair, row.query === "scenario" ? `scenario ${bucket}` : bucket].filter(Boolean).join(", ")) &&
      (isStudy || isOf("measured", `${row.query}, ${bucket}${order}`)) && isOf("body", bodyOf(pair)) &&
      (wanted.poses === undefined || order === ({ motion: " (motion)", path: " (path order)" }[wanted.poses] ?? ""));
  }

  /** Rows of the results that are about what is chosen and have no value in the figure, with their faults. */
  function failed(figure, shown, tables) {
    const { fails, where = {} } = figure.usermeta, table = tables.failures;
    if (!fails || !table) return [];
    const { choices, before } = shown, wanted = { ...where, ...choices }, ofAll = isAll(wanted.pair), key = keys[fails.key ?? "place"];
    const hasAxes = (row) => (figure.usermeta.axes ?? []).every((axis) => typeof row[choices[axis.field]] === "number");
    const places = new Set(key ? before.filter(hasAxes).map((row) => key(row, ofAll)) : []), found = new Map();
    for (const row of report.rowsOf(table).filter((each) => isAbout(each, wanted, fails))) {
      const isPoint = row.query === "precision";  // other resolutions of its algorithm may be drawn
      if (isPoint ? !row.fault.startsWith("not run") : key && places.has(key(row, ofAll))) continue;
      const id = isPoint ? found.size : JSON.stringify([row.algorithm, row.pair, row.bucket]), known = found.get(id);
      found.set(id, known ? { ...known, fault: `${known.fault}, ${row.fault}` } : row);
    }
    return [...found.values()];
  }

  /** What is not drawn, and which of the drawn values are of rows with a fault. */
  function missing(figure, shown, all, tables) {
    const { before, rows, choices } = shown, field = figure.usermeta.algorithm || "algorithm", parts = [];
    const failures = failed(figure, shown, tables);
    if (failures.length > 0) {
      const named = failures.map((row) => `${row.algorithm} at ${[row.pair, row.bucket].filter(Boolean).join(", ")} (${row.fault})`);
      parts.push(`${countText(failures.length, "row")} ${figure.usermeta.fails.words ?? "failed"} and ${failures.length === 1 ? "has" : "have"} no value here: ${listText(named, mostFailures)}`);
    }
    const faulty = rows.filter((row) => row.faults);
    if (faulty.length > 0) {
      parts.push(`${faulty.length} of ${countText(rows.length, "drawn value")} ${faulty.length === 1 ? "is" : "are"} of rows with wrong or missing answers: ` +
        listText([...new Set(faulty.map((row) => row[field]))], mostNames));
    }
    const means = rows.filter((row) => typeof row.objects === "number"), most = Math.max(0, ...means.map((row) => row.objects));
    const fewer = means.filter((row) => row.objects < most);
    if (fewer.length > 0) {
      parts.push(`${fewer.length} of ${countText(means.length, "mean")} ${fewer.length === 1 ? "is" : "are"} over fewer than ${most} objects: ` +
        listText([...new Set(fewer.map((row) => row[field]))], mostNames));
    }
    if (!figure.usermeta.noChips && field === "algorithm") {
      const present = new Set(before.map((row) => report.baseAlgorithm(row.algorithm)));
      const absent = [...new Set(all.filter((row) => choices.run === undefined || row.run === choices.run)
        .map((row) => report.baseAlgorithm(row.algorithm)))].filter((name) => !present.has(name));
      if (absent.length > 0) parts.push(`${countText(absent.length, "algorithm")} ${absent.length === 1 ? "has" : "have"} no row here: ${listText(absent, mostNames)}`);
      const off = new Set(before.map((row) => row.algorithm)).size - new Set(rows.map((row) => row.algorithm)).size;
      if (off > 0) parts.push(`${countText(off, "algorithm")} ${off === 1 ? "is" : "are"} switched off`);
    }
    return parts.length > 0 ? parts.join("; ") + "." : "";
  }

  /** How to get better numbers, where these are not good. */
  function advice(figure, rows, data) {
    const { value, times } = figure.usermeta, parts = [];
    if (value?.low) {
      const isMeasured = (row) => row.repetitions !== null && typeof row[value.low] === "number" && typeof row[value.high] === "number" && row[value.field] !== 0;
      const share = (row) => (row[value.high] - row[value.low]) / Math.abs(row[value.field]);
      const bounded = rows.filter(isMeasured), wide = bounded.filter((row) => share(row) > wideShare);
      if (wide.length > 0) {
        const widest = wide.reduce((a, b) => (share(b) > share(a) ? b : a));
        parts.push(`Of ${countText(bounded.length, "interval")} (95 %), ${wide.length} ${wide.length === 1 ? "is" : "are"} wider than ${100 * wideShare} % of the value (widest: ` +
          `${report.rowText(widest, rows, figure.usermeta)}). ${value.more ?? "More repetitions narrow them: --benchmark_repetitions=10."}`);
      }
    }
    const counted = rows.filter((row) => typeof row.repetitions === "number"), few = counted.filter((row) => row.repetitions < fewestRepetitions);
    if (few.length > 0) {
      parts.push(`${few.length === counted.length ? "All" : `${few.length} of ${counted.length}`} values were measured fewer than ${fewestRepetitions} times: ` +
        "an interval of 10 % to either side is assumed. --benchmark_repetitions=10 measures it.");
    }
    if (times) {
      const drawn = new Set(rows.map((row) => row.run).filter((run) => run !== undefined));
      const busy = data.runs.filter((each) => each.is_busy && (drawn.size === 0 || drawn.has(each.name)));
      if (busy.length > 0) {
        const names = busy.map((run) => `${data.runs.length > 1 ? run.name : "the run"}, load average ${report.numberText(run.load)} on ${countText(run.processors, "processor")}`);
        parts.push(`The machine did other work when this began, so times are longer and less equal than on an idle one: ${names.join("; ")}.`);
      }
    }
    return parts.join(" ");
  }

  /** @param shown of FigureCard.shown() @param all the figure's rows before any choice
   * @returns {ranked (the rows from the one on that the sentence names first), finding, missing, advice}, texts that may be empty */
  report.figureTexts = function (figure, shown, all, data) {
    const rows = report.drawnRows(figure, shown.rows);
    const found = rows.length === 0 ? null : figure.usermeta.value ? finding(figure, rows, shown.choices) : verdicts(figure, rows);
    return { ranked: found?.ranked ?? [], finding: found?.text ?? "", missing: missing(figure, { ...shown, rows }, all, data.tables), advice: advice(figure, rows, data) };
  };
})(globalThis.sixdofReport);
