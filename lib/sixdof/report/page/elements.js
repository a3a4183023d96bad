// Small pieces of the page. Texts of results become text nodes and attributes, never markup.

"use strict";

(function (report) {
  /** element("a", {href: "#x"}, "text", child, ...) */
  report.element = function (name, attributes, ...children) {
    const node = document.createElement(name);
    for (const [key, value] of Object.entries(attributes || {})) {
      if (key.startsWith("on")) {
        node.addEventListener(key.slice(2), value);
      } else if (value !== null && value !== undefined && value !== false) {
        node.setAttribute(key, value === true ? "" : String(value));
      }
    }
    for (const child of children) {
      if (child !== null && child !== undefined) node.append(typeof child === "object" ? child : String(child));
    }
    return node;
  };
  const element = report.element;

  /** A command line with a button that copies it. */
  report.commandLine = function (command) {
    const button = element("button", { type: "button", onclick: () => {
      if (navigator.clipboard) navigator.clipboard.writeText(command).then(() => { button.textContent = "copied"; }, () => {});
    } }, "copy");
    return element("div", { class: "command" }, element("code", {}, command), button);
  };

  report.download = function (name, type, text) {
    const address = URL.createObjectURL(new Blob([text], { type }));
    const link = element("a", { href: address, download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(address), 1000);
  };

  report.csvOf = function (columns, rows) {
    const cell = (value) => {
      let text = value === null || value === undefined ? "" : String(value);
      if (typeof value === "string" && /^[=+\-@\t\r]/.test(text)) text = "'" + text;
      return /[",\r\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text;
    };
    return [columns, ...rows].map((row) => row.map(cell).join(",") + "\r\n").join("");
  };

  const titles = { time_us: "time, µs", low_us: "from, µs", high_us: "to, µs", before_us: "before, µs", after_us: "after, µs",
                   times_faster: "times faster", time_ms: "time, ms", tau_ms: "wanted, ms", mean_ms: "mean, ms",
                   content_hash: "content hash", in_rows: "rows", worst_pose: "worst pose", mean_us: "mean, µs", p10_us: "10 % of objects, µs",
                   p90_us: "90 % of objects, µs", slowest_us: "its mean, µs", p99_us: "99 %, µs", longest_us: "longest, µs",
                   first_frame_us: "first frame, µs", tail_us: "tail, µs" };

  const firstRows = 100;

  /** A table that shows its first rows and, on request, all; a column whose cells are all empty or equal to one run is
   * left out. A click on a column's title sorts by it. */
  report.tableElement = function (name, table) {
    const kept = table.columns.map((column, i) => i).filter((i) => {
      const values = new Set(table.rows.map((row) => row[i]));
      return !(values.size === 1 && (values.has(null) || values.has("") || table.columns[i] === "run"));
    });
    let rows = table.rows, limit = firstRows, sorted = null;
    const body = element("tbody");
    const more = element("button", { type: "button", onclick: () => { limit = Infinity; fill(); } }, "");
    const format = (value) => (typeof value === "number" ? value.toLocaleString("en", { maximumSignificantDigits: 4 }) : value ?? "");
    function fill() {
      body.replaceChildren(...rows.slice(0, limit).map((row) => element("tr", {}, ...kept.map((i) => {
        const isCommand = table.columns[i] === "command" || table.columns[i] === "worst_pose";
        const isShort = typeof row[i] === "string" && row[i].length < 30;
        const address = table.columns[i] === "worst_pose" && row[i] ? report.sceneAddress({ worst_pose: row[i] }) : null;
        const cell = element("td", { class: typeof row[i] === "number" ? "number" : isCommand && !address ? "code" : isShort || address ? "short" : null });
        if (address) cell.append(element("a", { href: address }, "show in 3D"));
        else cell.append(isCommand && row[i] ? element("code", {}, row[i]) : String(format(row[i])));
        return cell;
      }))));
      more.hidden = rows.length <= limit;
      more.textContent = `show all ${rows.length} rows`;
    }
    function sortBy(i) {
      const sign = sorted === i ? -1 : 1;
      sorted = sorted === i ? null : i;
      rows = [...rows].sort((a, b) => sign * (typeof a[i] === "number" && typeof b[i] === "number"
        ? a[i] - b[i] : String(a[i] ?? "").localeCompare(String(b[i] ?? ""), "en", { numeric: true })));
      fill();
    }
    const head = element("tr", {}, ...kept.map((i) => element("th", { scope: "col" },
      element("button", { type: "button", title: "sort", onclick: () => sortBy(i) },
        titles[table.columns[i]] || table.columns[i].replace(/_/g, " ")))));
    fill();
    return element("div", { class: "table" },
      element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": table.title },
        element("table", {}, element("caption", {}, table.title), element("thead", {}, head), body)),
      more,
      element("button", { type: "button", onclick: () => report.download(name + ".csv", "text/csv", report.csvOf(table.columns, table.rows)) },
        "download as CSV"));
  };
})(globalThis.sixdofReport);
