// The live page: a window that asks for a case at every change, and shows what comes.
"use strict";

{
  const $ = (id) => document.getElementById(id);
  const { make } = vibroimpact;
  const SETTLED = 250;       // after the last change the case is computed in full [ms]

  // `asked`: number of the case that is under way, `tables`: those asked for, by number; `last`: what is shown, and `table`: of which case;
  // `opening`: number and name of the shipped case that is being opened, `opened`: name and table of the one that was;
  // `measured`: the file of the measurement, whether it was `sent`, and the number of the `overlay` asked for; `files`: numbers of the files asked for.
  const state = {
    socket: null, number: 0, asked: 0, shown: 0, wanted: null, tables: new Map(), offer: null, last: null, table: null, held: null, view: -1,
    retry: 500, timer: 0, notes: [], opening: [0, ""], opened: ["", ""], measured: null, overlay: 0, sent: false, files: new Set(),
  };
  const charts = new Map();
  const overlays = new Map();   // the charts of a measurement
  const controls = new vibroimpact.Controls($("controls"), (settled) => changed(settled));
  let scene = null;

  // ---- the address carries the case -----------------------------------------------------------------

  const through = async (bytes, stream) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
  const toFragment = async (table) => {
    const bytes = await through(new TextEncoder().encode(JSON.stringify(table)), new CompressionStream("deflate"));
    const letters = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
    return `#case=${letters.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
  };
  const fromFragment = async (fragment) => {
    const match = /^#case=([\w-]+)$/.exec(fragment);
    if (!match) return null;
    return JSON.parse(new TextDecoder().decode(await vibroimpact.inflated(match[1].replaceAll("-", "+").replaceAll("_", "/"))));
  };
  const remember = async (table) => {
    // the address may be that of another program, whose compression is not the browser's
    if (JSON.stringify(await fromFragment(location.hash).catch(() => null)) === JSON.stringify(table)) return;
    const fragment = await toFragment(table);
    if (location.hash) history.pushState(null, "", fragment); else history.replaceState(null, "", fragment);
  };
  // Open the case in the address; return whether there was to be one.
  const openAddress = async () => {
    if (!location.hash.startsWith("#case=")) return false;
    try {
      const table = await fromFragment(location.hash);
      if (typeof table !== "object" || table === null || Array.isArray(table)) throw new Error("not a table");
      begin(table);
    } catch {
      showFaults(["the address does not hold a case; choose one above"]);
    }
    return true;
  };

  // ---- asking -----------------------------------------------------------------------------------------

  const isOpen = () => Boolean(state.socket) && state.socket.readyState === WebSocket.OPEN;
  const send = (message) => {
    if (!isOpen()) return false;
    state.socket.send(JSON.stringify(message));
    return true;
  };
  // Ask for files, which the browser saves when they come.
  const askForFiles = (message) => {
    const number = ++state.number;
    $("saved").replaceChildren();
    if (send({ ...message, number })) state.files.add(number);
  };
  const isTooLong = (message) => {
    const size = new TextEncoder().encode(JSON.stringify(message)).length, most = state.offer?.longest;
    if (size > most) { setBusy(false); showFaults([`the case has ${size} bytes; ${most} are the most of the live page`]); }
    return size > most;
  };
  // Report and signals are those of the last case that was computed in full, and given where that is the one shown.
  const setBusy = (busy) => {
    const whole = !busy && state.last?.detail === "full";
    $("results").setAttribute("aria-busy", String(busy));
    $("get-report").disabled = !whole;
    $("get-export").disabled = !whole;
    $("get-signals").disabled = !whole || !(state.last.case.sensors || []).length;
  };

  // One draft is under way at a time; of those asked for meanwhile the last one is sent when it is done. The server gives up what takes long.
  const ask = (table, detail) => {
    state.wanted = { table, detail };
    setBusy(true);
    if (state.asked && detail === "draft" && state.detail === "draft" && !state.working) return;
    post();
  };
  const post = () => {
    if (!state.wanted) return;
    const { table, detail } = state.wanted;
    const seen = detail === "draft" && state.last ? { charts: [...charts].filter(([, chart]) => chart.seen).map(([name]) => name) } : {};
    const number = ++state.number, message = { type: "case", number, case: table, detail, ...seen };
    if (isTooLong(message)) state.wanted = null;
    else if (send(message)) { state.asked = number; state.detail = detail; state.tables.set(number, table); state.wanted = null; }
  };

  const changed = (settled) => {
    clearTimeout(state.timer);
    ask(controls.table, "draft");
    if (settled) state.timer = setTimeout(() => ask(controls.table, "full"), SETTLED);
  };

  const begin = (table) => { clearTimeout(state.timer); controls.begin(table); ask(table, "full"); };
  const open = (what) => {
    const number = ++state.number, message = { ...what, type: "open", number };
    if (isTooLong(message) || !send(message)) return;
    state.opening = [number, what.source || ""];
    setBusy(true);
  };
  // Nothing more comes of what was asked for: the plate of the last draft moves on.
  const stopWaiting = () => { setBusy(false); if (scene) scene.waiting = false; };
  // What was asked for is not shown: the controls go back to the case that is.
  const goBack = () => { if (state.last) controls.begin(state.table, state.last.case); showShipped(); };

  // ---- what comes ---------------------------------------------------------------------------------------

  const receive = {
    welcome(message) {
      state.offer = controls.offer = message;
      vibroimpact.setPalette(message.palette);
      $("shipped").replaceChildren(make("option", { value: "", text: "your own" }), ...Object.entries(message.cases).map(([name, title]) => make("option", { value: name, text: `${name}: ${title}` })));
      $("export").replaceChildren(...Object.entries(message.exports).map(([name, program]) => make("option", { value: name, text: `${name}: ${program}` })));
      $("file").accept = [".toml", ...message.endings].join(",");
      state.retry = 500;
      $("status").textContent = "";
      showShipped();
      if (controls.table) { ask(controls.table, "full"); return; }
      openAddress().then((found) => { if (!found) open({ source: "paper:type1-theory" }); });
    },
    opened(message) {
      state.opened = [state.opening[1], JSON.stringify(message.case)];
      state.notes = message.left_out;
      begin(message.case);
    },
    progress(message) {
      if (message.number !== state.asked) return;
      state.working = true;
      $("work").hidden = false;
      $("work-words").textContent = message.what;
      $("work-part").value = message.part;
    },
    state(message) {
      const table = state.tables.get(message.number);
      finished(message.number);
      if (message.number < state.shown) return;
      state.shown = message.number;
      showFaults([]);
      show(message, table);
    },
    fault(message) {
      if (state.files.delete(message.number)) { showSaved(message.lines, true); return; }
      if (message.number === state.overlay) { state.sent = false; showOverlay({ lines: message.lines }); return; }
      const beginning = controls.beginning && state.tables.get(message.number) === controls.table;
      if (finished(message.number)) { stopWaiting(); if (beginning) goBack(); else if (controls.table) controls.showAsked(); }
      if (message.number === state.opening[0]) { setBusy(Boolean(state.asked)); showShipped(); }
      showFaults(message.lines);
    },
    cancelled(message) {
      if (!finished(message.number)) return;
      stopWaiting();
      goBack();
      $("status").textContent = "Given up; the last case is shown.";
    },
    files(message) {
      state.files.delete(message.number);
      showSaved(message.notes || []);
      for (const file of message.files) {
        const content = file.bytes ? Uint8Array.from(file.bytes) : file.text;
        const link = make("a", { href: URL.createObjectURL(new Blob([content], { type: file.kind })), download: file.name });
        document.body.append(link);
        link.click();
        link.remove();
        setTimeout(() => URL.revokeObjectURL(link.href), 10000);
      }
    },
    overlay(message) { if (message.number === state.overlay) showOverlay(message); },
  };

  // What was asked for is done, whatever came of it; return whether nothing else is wanted.
  const finished = (number) => {
    if (number !== state.asked) return false;
    state.asked = 0;
    state.working = false;
    state.tables.clear();
    $("work").hidden = true;
    post();
    return !state.asked;
  };

  // ---- showing --------------------------------------------------------------------------------------------

  const showFaults = (lines) => {
    controls.showFaults(lines);
    $("faults").hidden = !lines.length;
    $("faults").replaceChildren(...lines.map((line) => make("p", { text: line })));
    const isOlder = lines.length > 0 && Boolean(state.last);
    $("older").hidden = !isOlder;
    $("results").classList.toggle("older", isOlder);
  };

  // The name of the shipped case that is shown, unless it was changed.
  const showShipped = () => { $("shipped").value = state.opened[1] && state.opened[1] === JSON.stringify(controls.table) ? state.opened[0] : ""; };

  const show = (message, table) => {
    // the controls show what came of what they ask for, not of what they asked for before
    const current = table === controls.table, settled = current && message.detail === "full";
    // a draft has the charts alone that are looked at
    state.last = message.detail === "full" || !state.last ? message : { ...message, charts: state.last.charts };
    state.table = table;
    document.title = `${message.name} – vibroimpact`;
    $("status").textContent = message.status;
    showAnswer(message.answer, message.detail === "draft");
    if (message.detail === "full") showWarnings(message.warnings);
    showImpacts(message.impacts);
    showLedger(message.ledger);
    showCharts(message.charts, message.names);
    showScene(message.scene, message.detail === "draft");
    showSound(message);
    if (settled || (current && !controls.moving)) controls.show(table, message.case);
    showShipped();
    $("get-toml").disabled = false;
    if (settled) remember(table);
    if (message.detail === "full") askForOverlay(); else $("overlay").classList.add("older");
    Promise.all([...charts.values()].filter((one) => one.near).map((one) => one.drawing)).then(() => {
      document.documentElement.dataset.drawn = String(message.number);
      document.documentElement.dataset.detail = message.detail;
      vibroimpact.drawn = (vibroimpact.drawn || 0) + 1;
      if (settled && table === controls.table) setBusy(false);
    });
  };

  // The main results, each with the error that its digits leave. A draft has those of the impacts alone.
  const showAnswer = (answer, isDraft) => {
    const names = answer.map((one) => one.name);
    const older = isDraft ? (state.answer || []).filter((one) => !names.includes(one.name)) : [];
    state.answer = [...answer, ...older];
    $("answer").replaceChildren(...state.answer.map((one) => make("div", { class: older.includes(one) ? "older" : false },
      make("dt", { text: one.name }), make("dd", { text: one.text }),
      ...(one.error ? [make("dd", { class: "error", text: one.error })] : []),
      ...(one.note ? [make("dd", { class: "note", text: one.note })] : []))));
  };

  // The warning that changes most is always open, the others are folded.
  const showWarnings = (warnings) => {
    const open = $("warnings").querySelector("details")?.open;
    const lines = warnings.map((one) => make("p", { class: `warning ${one.size}` }, make("strong", { text: "Warning:" }), ` ${one.text}.`));
    const others = lines.slice(1);
    $("warnings").replaceChildren(...state.notes.map((text) => make("p", { text })), ...lines.slice(0, 1), ...(others.length
      ? [make("details", { open }, make("summary", { text: others.length === 1 ? "1 more warning" : `${others.length} more warnings` }), ...others)]
      : []));
  };

  const tableOf = (headers, rows, held) => make("table", {},
    make("thead", {}, make("tr", {}, ...headers.map(([name, unit]) => make("th", { scope: "col", text: name }, ...(unit ? [make("span", { class: "unit", text: unit })] : []))))),
    make("tbody", {}, ...rows.map((row) => make("tr", {}, ...row.map((cell, index) => make(index ? "td" : "th", index ? { text: cell } : { scope: "row", text: cell })))),
      ...(held || []).map((row) => make("tr", { class: "held" }, ...row.map((cell, index) => make(index ? "td" : "th", index ? { text: cell } : { scope: "row", text: `held ${cell}` }))))));

  // What is held may be told in other multiples of its units: then they stand beside its numbers.
  const heldCell = (cell, unit, now) => (unit === now || cell === "–" ? cell : `${cell} ${unit}`);

  const showImpacts = ({ headers, rows, left_out }) => {
    const held = state.held?.impacts, places = new Map((held?.headers || []).map(([name], place) => [name, place]));
    const heldRow = (row) => headers.map(([name, unit]) => (places.has(name) ? heldCell(row[places.get(name)], held.headers[places.get(name)][1], unit) : "–"));
    $("impacts").replaceChildren(
      rows.length ? tableOf(headers, rows, held ? held.rows.slice(0, rows.length).map(heldRow) : []) : make("p", { text: "No impact within the run." }),
      ...(left_out ? [make("p", { class: "note", text: `${left_out} more between them.` })] : []),
    );
  };

  const showLedger = ({ unit, rows }) => {
    const before = state.held?.ledger, held = new Map((before?.rows || []).map(([name, energy]) => [name, heldCell(energy, before.unit, unit)]));
    const names = new Set(rows.map(([name]) => name)), sums = rows.slice(-2), gone = [...held.keys()].filter((name) => !names.has(name)).map((name) => [name, "–", "–"]);
    $("ledger").replaceChildren(tableOf(
      [["Energy at the end", ""], ["", unit], ["", "%"], ...(before ? [["held", unit]] : [])],
      [...rows.slice(0, -2), ...gone, ...sums].map((row) => [...row, ...(before ? [held.get(row[0]) ?? "–"] : [])]),
    ));
  };

  // Show the charts that came; of those that did not, the ones that there no longer are go away.
  const showCharts = (given, all) => {
    const views = given.reduce((most, chart) => (chart.views.length > most.length ? chart.views : most), []);
    const select = $("view");
    // of a draft there may be charts alone that have no views
    if ((views.length || given.length === all.length) && select.options.length !== views.length + 1) {
      select.replaceChildren(make("option", { value: -1, text: "whole run" }), ...views.map((view, index) => make("option", { value: index, text: view.name })));
      if (state.view >= views.length) state.view = -1;
      showPlace();
    }
    const names = new Set(all);
    for (const name of [...charts.keys()]) if (!names.has(name)) endChart(charts, name);
    let before = null;
    for (const chart of given) {
      const ghost = state.held ? state.held.charts.find((one) => one.name === chart.name) || null : null;
      const section = showChart(charts, chart.name === "position" ? $("lead-chart") : $("charts"), chart, ghost);
      // charts stand in the order given, also those that come later
      if (chart.name !== "position") { if (section.previousElementSibling !== before) $("charts").insertBefore(section, before ? before.nextSibling : $("charts").firstChild); before = section; }
    }
  };

  // Show a chart in its section, which is made at the end of a part of the page if there is none; return the section.
  const showChart = (known, part, chart, ghost) => {
    if (!known.has(chart.name)) {
      const element = make("div", { class: "chart", role: "img", style: `min-height: ${chart.layout.height + 90}px` });
      part.append(make("section", { id: `chart-${chart.name}` }, make("div", { class: "heading" }, make("h2", { text: chart.title }), saveMenu(chart)), make("p", { class: "headline" }), element));
      known.set(chart.name, new vibroimpact.Chart(element, chart));
    }
    const one = known.get(chart.name), section = one.element.parentElement;
    section.querySelector("h2").textContent = chart.title;
    one.element.setAttribute("aria-label", `${chart.title}. ${chart.caption}`);
    one.update({ chart, ghost, view: viewOf(known, chart) });
    headline(one);
    return section;
  };
  // Contacts of a measurement are too short to be seen in a whole run: there the first one is shown.
  const viewOf = (known, chart) => {
    const view = known === overlays ? Math.max(state.view, 0) : state.view;
    return view < 0 || view >= chart.views.length ? null : view;
  };
  const endChart = (known, name) => {
    const chart = known.get(name);
    Plotly.purge(chart.element);
    chart.end();
    chart.element.closest("section").remove();
    known.delete(name);
  };
  // The formats in which a chart is saved as a figure.
  const saveMenu = (chart) => {
    const buttons = ["png", "svg", "pdf"].map((format) => {
      const button = make("button", { type: "button", text: format.toUpperCase(), "aria-label": `${chart.title} as ${format.toUpperCase()}` });
      button.addEventListener("click", () => askForFiles({ type: "figure", chart: chart.name, format }));
      return button;
    });
    return make("details", { class: "save" }, make("summary", { text: "Save", "aria-label": `Save ${chart.title}` }), make("span", { class: "pair" }, ...buttons));
  };

  const headline = (one) => { one.element.parentElement.querySelector(".headline").textContent = one.headline; };

  const showPlace = () => {
    $("view").value = String(state.view);
    $("view-before").disabled = state.view < 0;
    $("view-after").disabled = state.view + 2 >= $("view").options.length;
  };

  const showView = (number) => {
    state.view = number;
    showPlace();
    for (const known of [charts, overlays]) for (const one of known.values()) { one.update({ view: viewOf(known, one.chart), ranges: {} }); headline(one); }
  };

  const showScene = (given, waiting) => {
    if (scene) { scene.waiting = waiting; scene.setScene(given); return; }
    scene = vibroimpact.controlScene($("scene"), given, (x, y, settled) => {
      const plate = controls.resolved.plate;
      if (plate.radius !== undefined || !plate.size) return;
      const rounded = (value, side) => Math.min(Math.max(Number((1000 * value).toPrecision(3)), -500 * plate.size[side]), 500 * plate.size[side]);
      controls.change((table) => { table.drop.position = [x, y].map((value, side) => `${rounded(value, side)} mm`); }, settled);
    });
  };

  const showSound = (message) => {
    const select = $("sound-of");
    const names = (message.case.sensors || []).map((sensor) => sensor.name);
    if (names.join("\n") !== Array.from(select.options, (option) => option.text).join("\n")) select.replaceChildren(...names.map((name, index) => make("option", { value: index, text: name })));
    $("sound").hidden = !names.length;
    $("sound-play").disabled = message.detail !== "full";
  };

  // ---- a measurement over what is computed ------------------------------------------------------------------

  const openMeasurement = (file) => {
    closeMeasurement();
    state.measured = file;
    $("overlay").hidden = false;
    $("overlay-title").textContent = `Measurement: ${file.name}`;
    $("overlay").scrollIntoView({ block: "start" });
    $("overlay").focus({ preventScroll: true });
    if (file.size > state.offer.longest_file) {
      state.measured = null;
      showOverlay({ lines: [`${file.name}: the file has ${file.size} bytes, more than the ${state.offer.longest_file} of the live page; keep the part with the impacts, or use: vibroimpact correlate`] });
      return;
    }
    askForOverlay();
  };

  // The file is sent once; what is computed later is laid under the measurement that the server keeps.
  const askForOverlay = async () => {
    const file = state.measured;
    if (!file || !isOpen() || state.last?.detail !== "full") return;
    const number = ++state.number;
    state.overlay = number;
    $("overlay").setAttribute("aria-busy", "true");
    if (state.sent) { send({ type: "overlay", number }); return; }
    state.sent = true;
    const line = `\0${JSON.stringify({ type: "measurement", number, name: file.name.slice(-200) })}\n`;
    const block = await new Blob([line, file]).arrayBuffer();
    if (isOpen() && state.measured === file) state.socket.send(block); else state.sent = false;
  };

  // Show a measurement over what was computed, or the lines of a message in its place.
  const showOverlay = ({ charts: given = [], tables = [], notes = [], lines = [] }) => {
    $("overlay").setAttribute("aria-busy", "false");
    $("overlay").classList.remove("older");
    $("overlay-faults").replaceChildren(...lines.map((text) => make("p", { text })));
    $("overlay-notes").replaceChildren(...notes.map((text) => make("p", { class: "note", text: `${text[0].toUpperCase()}${text.slice(1)}.` })));
    const names = new Set(given.map((chart) => chart.name));
    for (const name of [...overlays.keys()]) if (!names.has(name)) endChart(overlays, name);
    for (const chart of given) showChart(overlays, $("overlay-charts"), chart, null);
    $("overlay-tables").replaceChildren(...tables.map(({ headers, rows }) => tableOf(headers, rows)));
  };

  const closeMeasurement = () => {
    if (state.measured) send({ type: "forget", number: ++state.number });
    Object.assign(state, { measured: null, sent: false, overlay: 0 });
    showOverlay({});
    $("overlay").hidden = true;
  };

  // What a format of an export can't hold, or why there is no file.
  const showSaved = (lines, failed = false) => {
    $("saved").classList.toggle("failed", failed);
    $("saved").replaceChildren(...lines.map((text) => make("p", { text })));
  };

  // ---- the controls of the page -------------------------------------------------------------------------------

  // What is shown is not older than what is asked for: a file that is not read changes nothing.
  const refuse = (lines) => {
    showFaults(lines);
    $("older").hidden = true;
    $("results").classList.remove("older");
  };

  const openFile = async (file) => {
    if (!file) return;
    const name = file.name.toLowerCase();
    if (state.offer?.endings.some((ending) => name.endsWith(ending))) { openMeasurement(file); return; }
    if (state.offer && !name.endsWith(".toml")) {
      refuse([`${file.name}: the page reads the TOML file of a case, and of a measurement files ending in ${state.offer.endings.join(", ")}; convert it, or use: vibroimpact correlate`]);
      return;
    }
    if (file.size > 150000) { showFaults([`${file.name}: the file has ${file.size} bytes, and a case is a page of text`]); return; }
    open({ text: await file.text() });
  };

  const download = (name, text, kind) => receive.files({ files: [{ name, text, kind }] });

  const connectPage = () => {
    $("shipped").addEventListener("change", () => { if ($("shipped").value) open({ source: $("shipped").value }); });
    $("file").addEventListener("change", () => { openFile($("file").files[0]); $("file").value = ""; });
    for (const name of ["dragover", "dragenter"]) addEventListener(name, (event) => { if (event.dataTransfer?.types.includes("Files")) { event.preventDefault(); $("drop").hidden = false; } });
    addEventListener("dragleave", (event) => { if (!event.relatedTarget) $("drop").hidden = true; });
    addEventListener("drop", (event) => {
      event.preventDefault();
      $("drop").hidden = true;
      const files = event.dataTransfer?.files || [];
      if (files.length > 1) refuse([`${files.length} files were dropped; the page opens one at a time`]); else openFile(files[0]);
    });
    $("hold").addEventListener("click", () => {
      state.held = state.held ? null : state.last;
      $("hold").setAttribute("aria-pressed", String(Boolean(state.held)));
      $("hold").textContent = state.held ? "Release" : "Hold to compare";
      if (state.last) { showImpacts(state.last.impacts); showLedger(state.last.ledger); showCharts(state.last.charts, state.last.names); }
    });
    $("get-toml").addEventListener("click", () => download("case.toml", state.last.toml, "application/toml"));
    $("get-report").addEventListener("click", () => askForFiles({ type: "report" }));
    $("get-signals").addEventListener("click", () => askForFiles({ type: "signals" }));
    $("get-export").addEventListener("click", () => askForFiles({ type: "export", format: $("export").value }));
    $("overlay-close").addEventListener("click", () => { closeMeasurement(); $("file").focus(); });
    $("cancel").addEventListener("click", () => { clearTimeout(state.timer); state.wanted = null; send({ type: "cancel", number: state.asked }); });
    $("theme").addEventListener("click", () => setTheme(vibroimpact.theme === "dark" ? "light" : "dark"));
    $("view").addEventListener("change", () => showView(Number($("view").value)));
    $("view-before").addEventListener("click", () => showView(state.view - 1));
    $("view-after").addEventListener("click", () => showView(state.view + 1));
    showPlace();
    let sounding = false;
    $("sound-play").addEventListener("click", () => {
      if (sounding) { vibroimpact.stopSound(); return; }
      const signal = state.last.signals[Number($("sound-of").value)];
      if (!signal) return;
      sounding = true;
      $("sound-play").textContent = "Stop";
      vibroimpact.playSound(signal, Number($("sound-slowed").value), () => { sounding = false; $("sound-play").textContent = "Play the sound"; });
    });
    addEventListener("popstate", openAddress);
    // the address is that of the case: going to the results leaves it
    document.querySelector(".skip").addEventListener("click", (event) => { event.preventDefault(); $("results").focus(); });
    $("get-toml").disabled = true;
    setBusy(false);
  };

  const setTheme = (theme) => {
    document.documentElement.dataset.theme = theme;
    vibroimpact.setTheme(theme);
    for (const chart of [...charts.values(), ...overlays.values()]) chart.update();
    if (scene) scene.draw();
  };

  // The connection comes back by itself after the server was started again; the case goes on where it was.
  const connect = () => {
    const socket = new WebSocket(`ws://${location.host}/live`);
    socket.binaryType = "arraybuffer";
    state.socket = socket;
    socket.addEventListener("open", () => { document.documentElement.dataset.connected = "true"; });
    socket.addEventListener("message", (event) => { const message = vibroimpact.unpack(event.data); receive[message.type](message); });
    socket.addEventListener("close", (event) => {
      delete document.documentElement.dataset.connected;
      state.asked = 0;
      state.sent = false;
      state.files.clear();
      state.working = false;
      state.wanted = null;
      state.tables.clear();
      $("work").hidden = true;
      $("status").textContent = event.reason || "The server does not answer; the page tries again. To start it: vibroimpact serve";
      setTimeout(connect, state.retry);
      state.retry = Math.min(2 * state.retry, 5000);
    });
  };

  vibroimpact.setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  document.documentElement.dataset.theme = vibroimpact.theme;
  connectPage();
  connect();
  vibroimpact.live = { state, charts, overlays, controls, get scene() { return scene; } };
}
