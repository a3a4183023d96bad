// One figure on the page: its choices, the algorithms that it shows, the plot, what a click tells, downloads.

"use strict";

(function (report) {
  const element = report.element;

  function chip(name, index, state, redraw) {
    const box = element("input", { type: "checkbox", checked: !state.hidden.has(name), onchange: () => {
      if (box.checked) state.hidden.delete(name); else state.hidden.add(name);
      redraw();
    } });
    const swatch = element("span", { class: "swatch " + report.shapeOf(index), "aria-hidden": "true" });
    swatch.style.setProperty("--colour", report.colourOf(index, report.theme));
    return element("label", { class: "chip" }, box, swatch, name);
  }

  /** The sentence under a plot: what is not in it. */
  function missingText(rows, shown, field) {
    const faulty = rows.filter((row) => row.faults).length;
    const hidden = new Set(rows.map((row) => row[field])).size - new Set(shown.map((row) => row[field])).size;
    const parts = [];
    if (faulty) parts.push(`${faulty} of ${rows.length} values are of rows with faults (see Failures)`);
    if (hidden) parts.push(`${hidden} algorithms are switched off`);
    return parts.join("; ");
  }

  class FigureCard {
    constructor(figure, data) {
      this.figure = figure;
      this.meta = figure.usermeta;
      this.data = data;
      this.all = report.figureRows(figure, data.tables);
      this.choices = {};
      this.state = { hidden: new Set() };
      this.linear = false;
      this.views = [];
      this.controls = element("div", { class: "controls" });
      this.chips = element("div", { class: "chips", role: "group", "aria-label": "Algorithms" });
      this.plots = element("div", { class: "plots" });
      this.detail = element("div", { class: "detail", "aria-live": "polite" });
      this.missing = element("p", { class: "missing" });
      this.element = element("section", { class: "figure", id: "figure-" + this.meta.id },
        element("h3", {}, this.meta.title), this.controls, this.plots, this.chips, this.missing, this.detail,
        element("p", { class: "caption" }, this.meta.caption), this.downloads());
    }

    downloads() {
      return element("div", { class: "downloads" },
        element("button", { type: "button", onclick: () => this.downloadSvg() }, "SVG"),
        element("button", { type: "button", onclick: () => {
          const columns = this.data.tables[this.meta.table].columns;
          const rows = this.shown().rows.map((row) => columns.map((column) => row[column]));
          report.download(this.meta.id + ".csv", "text/csv", report.csvOf(columns, rows));
        } }, "data"));
    }

    field() { return this.meta.algorithm || "algorithm"; }

    shown() {
      const { resolved, rows } = report.resolveChoices(this.figure, this.all, this.choices);
      const visible = this.meta.noChips ? rows : rows.filter((row) => !this.state.hidden.has(row[this.field()]));
      const choices = Object.fromEntries(resolved.map(({ filter, value }) => [filter.field, value]));
      return { resolved, choices, before: rows, rows: visible };
    }

    drawControls(resolved) {
      const parts = resolved.filter(({ values }) => values.length > 1).map(({ filter, values, value }) => {
        const select = element("select", { onchange: () => { this.choices[filter.field] = select.value; this.draw(); } },
          ...values.map((each) => element("option", { value: each, selected: each === value }, each)));
        return element("label", {}, filter.label + " ", select);
      });
      if (this.meta.logAxes) {
        const box = element("input", { type: "checkbox", checked: !this.linear, onchange: () => { this.linear = !box.checked; this.draw(); } });
        parts.push(element("label", { class: "chip" }, box, "logarithmic axes"));
      }
      this.controls.replaceChildren(...parts);
    }

    drawChips(rows) {
      const names = report.valuesOf(rows, this.field());
      const index = (name) => Math.max(0, this.data.algorithms.indexOf(report.baseAlgorithm(name)));
      names.sort((a, b) => index(a) - index(b));
      this.chips.replaceChildren(...(this.meta.noChips ? [] : names.map((name) => chip(name, index(name), this.state, () => this.draw()))));
    }

    spec(rows, choices, more) {
      return report.prepareSpec(this.figure, rows, choices,
        { theme: report.theme, algorithms: this.data.algorithms, width: "container", legend: false, linear: this.linear, ...more });
    }

    async draw() {
      const { resolved, choices, before, rows } = this.shown();
      this.drawControls(resolved);
      this.drawChips(before);
      this.missing.textContent = missingText(before, rows, this.field());
      for (const view of this.views) view.finalize();
      this.views = [];
      const facets = this.meta.facet ? report.valuesOf(rows, this.meta.facet) : [null];
      this.plots.classList.toggle("facets", facets.length > 1);
      const places = facets.map(() => element("div", { class: "plot" }));
      const cells = this.meta.cells ? this.meta.cells.width * (report.valuesOf(rows, this.meta.cells.field).length + 2) : 0;
      for (const place of places) place.style.minWidth = `${this.meta.minWidth || cells}px`;  // a phone scrolls within the figure
      this.plots.replaceChildren(...places);
      for (let i = 0; i < facets.length; ++i) {
        const part = facets[i] === null ? rows : rows.filter((row) => row[this.meta.facet] === facets[i]);
        const spec = this.spec(part, choices, { title: facets[i] === null ? undefined : String(facets[i]) });
        const { view } = await vegaEmbed(places[i], spec, { actions: false, renderer: "svg", tooltip: { theme: report.theme } });
        places[i].querySelector("svg")?.setAttribute("aria-label", `${this.meta.title}. ${this.meta.caption}`);
        view.addEventListener("click", (event, item) => this.tell(item && item.datum));
        this.views.push(view);
      }
      this.element.dataset.drawn = String(rows.length);
    }

    /** What stands behind a mark: all its fields, and the command that measures it again. */
    tell(datum) {
      const columns = this.data.tables[this.meta.table].columns;
      if (!datum || !columns.some((column) => datum[column] !== undefined)) return;
      const fields = columns.filter((column) => column !== "command" && datum[column] !== null && datum[column] !== "" && datum[column] !== undefined);
      this.detail.replaceChildren(element("dl", {}, ...fields.flatMap((column) =>
        [element("dt", {}, column.replace(/_/g, " ")), element("dd", {}, datum[column])])));
      if (datum.command) this.detail.append(report.commandLine(datum.command));
      const scene = report.findScene(`${datum.scenario ?? datum.family}: ${datum.algorithm}`);
      if (scene >= 0) {
        this.detail.append(element("button", { type: "button", class: "to-scene", onclick: () => report.showScene(scene, datum.time_ms) }, "show in 3D"));
      }
    }

    async downloadSvg() {
      const { choices, rows } = this.shown();
      const facet = this.meta.facet ? report.valuesOf(rows, this.meta.facet)[0] : null;
      const part = facet === null ? rows : rows.filter((row) => row[this.meta.facet] === facet);
      const spec = this.spec(part, choices, { width: 640, legend: true, title: this.meta.title });
      const view = new vega.View(vega.parse(vegaLite.compile(spec).spec), { renderer: "none" });
      report.download(this.meta.id + ".svg", "image/svg+xml", await view.toSVG());
      view.finalize();
    }
  }
  report.FigureCard = FigureCard;
})(globalThis.sixdofReport);
