// One figure on the page: its choices, the algorithms that it shows, the plot, what a click tells, downloads.

"use strict";

(function (report) {
  const element = report.element;

  function chip(name, style, state, redraw) {
    const box = element("input", { type: "checkbox", checked: !state.hidden.has(name), onchange: () => {
      if (box.checked) state.hidden.delete(name); else state.hidden.add(name);
      redraw();
    } });
    const swatch = element("span", { class: "swatch " + report.shapeOf(style), "aria-hidden": "true" });
    swatch.style.setProperty("--colour", report.colourOf(style, report.theme));
    return element("label", { class: "chip" }, box, swatch, name);
  }

  /** Puts new controls in the place of old ones. The focus stays where it was, so that a keyboard goes on from there. */
  function replaceControls(parent, parts) {
    const at = [...parent.children].findIndex((child) => child.contains(document.activeElement));
    parent.replaceChildren(...parts);
    parts[at]?.querySelector("select, input")?.focus();
  }

  class FigureCard {
    constructor(figure, data) {
      this.figure = figure;
      this.meta = figure.usermeta;
      this.data = data;
      this.all = report.figureRows(figure, data.tables);
      this.choices = { ...data.choices };
      this.state = { hidden: new Set() };
      this.linear = false;
      this.views = [];
      this.controls = element("div", { class: "controls" });
      this.chips = element("div", { class: "chips", role: "group", "aria-label": "Algorithms" });
      this.plots = element("div", { class: "plots" });
      this.detail = element("div", { class: "detail", "aria-live": "polite" });
      this.missing = element("p", { class: "missing" });
      this.finding = element("p", { class: "finding" });
      this.advice = element("p", { class: "advice" });
      this.element = element("section", { class: "figure", id: "figure-" + this.meta.id },
        element("h3", {}, this.meta.title), this.controls, this.plots, this.chips, this.finding, this.missing, this.advice, this.detail,
        element("p", { class: "caption" }, this.meta.caption), this.downloads());
    }

    downloads() {
      return element("div", { class: "downloads" },
        element("button", { type: "button", onclick: () => this.downloadSvg() }, "SVG"),
        element("button", { type: "button", onclick: () => {
          const columns = this.data.tables[this.meta.table].columns;
          const rows = this.shown().rows.map((row) => columns.map((column) => row[column]));
          report.download(this.meta.id + ".csv", "text/csv", report.csvOf(columns, [...new Map(rows.map((row) => [JSON.stringify(row), row])).values()]));
        } }, "data"));
    }

    field() { return this.meta.algorithm || "algorithm"; }

    shown() {
      const { resolved, choices, rows } = report.resolveChoices(this.figure, this.all, this.choices, this.data.metrics);
      const visible = this.meta.noChips ? rows : rows.filter((row) => !this.state.hidden.has(row[this.field()]));
      return { resolved, choices, before: rows, rows: report.withAxes(this.figure, visible, choices, this.data.metrics) };
    }

    drawControls(resolved) {
      const parts = resolved.filter(({ values }) => values.length > 1).map(({ filter, values, value }) => {
        const select = element("select", { onchange: () => { this.choices[filter.field] = select.value; this.draw(); } },
          ...values.map((each) => element("option", { value: each, selected: each === value }, filter.names ? filter.names(each) : each)));
        return element("label", {}, filter.label + " ", select);
      });
      if (this.meta.logAxes) {
        const box = element("input", { type: "checkbox", checked: !this.linear, onchange: () => { this.linear = !box.checked; this.draw(); } });
        parts.push(element("label", { class: "chip" }, box, "logarithmic axes"));
      }
      replaceControls(this.controls, parts);
    }

    drawChips(rows) {
      const names = report.legendOrder(this.figure, report.drawnRows(this.figure, rows), this.data.algorithms);
      const style = (name) => report.styleOf(name, this.data.algorithms);
      replaceControls(this.chips, this.meta.noChips ? [] : names.map((name) => chip(name, style(name), this.state, () => this.draw())));
    }

    /** The sentences under the plot, with a link to the pose or moment of the worst value that is known. */
    drawTexts(shown) {
      const { ranked, finding, missing, advice } = report.figureTexts(this.figure, shown, this.all, this.data);
      const known = ranked.find((row) => report.sceneAddress(row));
      const what = known === ranked[0] && this.meta.value ? "its pose" : known && report.rowText(known, ranked, this.meta);
      this.finding.replaceChildren(finding, ...(known ? [" ", element("a", { href: report.sceneAddress(known) }, `Show ${what} in 3D`)] : []));
      this.missing.textContent = missing;
      this.advice.textContent = advice;
    }

    spec(rows, choices, more) {
      return report.prepareSpec(this.figure, rows, choices,
        { theme: report.theme, algorithms: this.data.algorithms, width: "container", room: Math.max(this.plots.clientWidth, this.meta.minWidth || 0), legend: false, linear: this.linear, ...more });
    }

    async draw() {
      const shown = this.shown(), { resolved, choices, before, rows } = shown;
      this.drawControls(resolved);
      this.drawChips(report.withAxes(this.figure, before, choices, this.data.metrics));
      this.drawTexts(shown);
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
      const fields = columns.filter((column) => column !== "command" && column !== "worst_pose" && datum[column] !== null && datum[column] !== "" && datum[column] !== undefined);
      this.detail.replaceChildren(element("dl", {}, ...fields.flatMap((column) =>
        [element("dt", {}, column.replace(/_/g, " ")), element("dd", {}, datum[column])])));
      if (datum.command) this.detail.append(report.commandLine(datum.command));
      if (datum.worst_pose) this.detail.append(element("p", {}, "The pose where it is at its worst:"), report.commandLine(datum.worst_pose));
      const address = report.sceneAddress(datum);
      if (address) this.detail.append(element("a", { class: "to-scene", href: address }, "Show in 3D"));
    }

    async downloadSvg() {
      const { choices, rows } = this.shown();
      const facet = this.meta.facet ? report.valuesOf(rows, this.meta.facet)[0] : null;
      const part = facet === null ? rows : rows.filter((row) => row[this.meta.facet] === facet);
      const spec = this.spec(part, choices, { width: 640, legend: true, title: report.titleOf(this.figure, choices, facet, this.all) });
      const view = new vega.View(vega.parse(vegaLite.compile(spec).spec), { renderer: "none" });
      report.download(this.meta.id + ".svg", "image/svg+xml", await view.toSVG());
      view.finalize();
    }
  }
  report.FigureCard = FigureCard;
})(globalThis.sixdofReport);
