// The report's pages: one is shown at a time, chosen by the address's part behind '#'. A page is drawn when it is first
// shown, so that the first one is there at once.

"use strict";

(function (report) {
  const element = report.element;
  const data = report.unpack(JSON.parse(document.getElementById("report-data").textContent));
  report.data = data;
  report.cards = {};
  const drawn = {};

  const hasRows = (name) => data.tables[name] && data.tables[name].rows.length > 0;

  /** A page without data says which command fills it. */
  function emptyNote(page) {
    return element("div", { class: "empty" },
      element("p", {}, page.none && data.tables.runs.rows.length ? page.none : "These files have no data for this page. This command makes them:"),
      page.none && data.tables.runs.rows.length ? null : report.commandLine(page.command));
  }

  function comparisonText() {
    return data.comparisons.map(({ before, after, sentences }) => element("div", { class: "sentences" },
      element("h3", {}, `${before} → ${after}`), ...sentences.map((sentence) => element("p", {}, sentence))));
  }

  function build(page) {
    const node = element("article", { id: "page-" + page.id },
      element("h2", {}, page.title), element("p", { class: "intro" }, page.intro));
    if (page.summary) {
      node.append(element("div", { class: "sentences verdict" }, ...data.summary.map((sentence) => element("p", {}, sentence))));
    }
    if (page.comparisons) node.append(...comparisonText());
    const extra = page.pictures && report.objectPictures(data);
    if (extra) node.append(extra);
    if (page.scenes && data.scenes.length > 0) {
      report.view = new report.SceneView(data);
      node.append(report.view.element);
    }
    const figures = page.figures.filter((id) => data.figures[id] && report.figureRows(data.figures[id], data.tables).length > 0);
    const tables = page.tables.filter(hasRows);
    for (const id of figures) {
      const card = new report.FigureCard(data.figures[id], data);
      report.cards[id] = card;
      node.append(card.element);
    }
    for (const id of page.figures) {
      if (!figures.includes(id) && (figures.length > 0 || tables.length > 0) && data.figures[id]) {
        node.append(element("p", { class: "missing" }, `${data.figures[id].usermeta.title}: these files have no data for it.`));
      }
    }
    for (const name of tables) {
      const table = data.tables[name];
      node.append(element("details", { open: page.figures.length === 0 || name === "answers" },
        element("summary", {}, `${table.title}: ${table.rows.length} lines`), report.tableElement(name, table)));
    }
    if (figures.length === 0 && tables.length === 0 && !page.summary && !extra && !(page.scenes && data.scenes.length > 0)) node.append(emptyNote(page));
    return { node, figures };
  }

  async function drawAll(figures) {
    for (const id of figures) {
      try {
        await report.cards[id].draw();
      } catch (error) {
        report.cards[id].plots.replaceChildren(element("p", { class: "empty" }, "This figure could not be drawn: " + error.message));
        console.error(id, error);
      }
    }
  }

  /** @param address "PAGE", or "view/SCENE" or "view/SCENE/MOMENT" with numbers of data.scenes and its moments */
  async function show(address) {
    const [id, scene, moment] = address.split("/");
    const page = data.pages.find((each) => each.id === id) || data.pages[0];
    for (const folded of document.querySelectorAll("nav details")) folded.open = false;
    for (const link of document.querySelectorAll("nav a")) {
      if (link.hash === "#" + page.id) link.setAttribute("aria-current", "page"); else link.removeAttribute("aria-current");
    }
    const isNew = !drawn[page.id];
    if (isNew) drawn[page.id] = build(page);
    document.getElementById("content").replaceChildren(drawn[page.id].node);
    document.title = `${page.title} - sixdof report`;
    if (isNew || drawn[page.id].theme !== report.theme) await drawAll(drawn[page.id].figures);
    drawn[page.id].theme = report.theme;
    if (page.scenes && report.view) {
      report.view.attach();
      if (data.scenes[scene]) report.view.choose(Number(scene), moment === undefined ? undefined : Number(moment));
    } else if (report.view) {
      report.view.stop();
    }
    report.ready = page.id;
  }
  report.show = show;

  const sceneOfCommand = new Map(data.scenes.map((scene, i) => [scene.command, i]));
  const sceneOfName = new Map(data.scenes.map((scene, i) => [scene.name, i]));

  /** Address of what a row of a table is about in the page of bodies: the configuration where it is at its worst, a path
   * and, with a time, its moment, or a hard case; null where the page has none. */
  report.sceneAddress = function (row) {
    if (row.worst_pose && sceneOfCommand.has(row.worst_pose)) return "#view/" + sceneOfCommand.get(row.worst_pose);
    const scene = sceneOfName.get(`${row.scenario ?? row.family}: ${row.algorithm}`);
    if (scene === undefined) return null;
    if (typeof row.time_ms !== "number") return "#view/" + scene;
    const { moments, stride, rate_hz: rate } = data.scenes[scene];
    return `#view/${scene}/${Math.min(moments.length - 1, Math.max(0, Math.round(row.time_ms / 1000 * rate / stride)))}`;
  };

  function setTheme(theme) {
    report.theme = theme;
    document.documentElement.dataset.theme = theme;
    const button = document.getElementById("theme");
    button.textContent = theme === "dark" ? "Light" : "Dark";
    button.setAttribute("aria-pressed", String(theme === "dark"));
  }

  document.getElementById("made-from").textContent = data.made_from;
  const isFull = (page) => page.summary || page.tables.some(hasRows) || (page.scenes && data.scenes.length > 0) ||
    page.figures.some((id) => data.figures[id] && report.figureRows(data.figures[id], data.tables).length > 0);
  const linkOf = (page) => element("a", { href: "#" + page.id }, page.title);
  const empty = data.pages.filter((page) => !isFull(page));
  const folded = element("details", { class: "others" }, element("summary", {}, `without data: ${empty.length}`), element("div", {}, ...empty.map(linkOf)));
  document.getElementById("pages").append(...data.pages.filter(isFull).map(linkOf), ...(empty.length > 0 ? [folded] : []));
  document.getElementById("theme").addEventListener("click", () => {
    setTheme(report.theme === "dark" ? "light" : "dark");
    show(location.hash.slice(1));
  });
  setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  addEventListener("hashchange", () => show(location.hash.slice(1)));
  show(location.hash.slice(1));
})(globalThis.sixdofReport);
