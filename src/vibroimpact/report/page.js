// A report: draws its charts from the data in the page, and connects its controls.
"use strict";

{
  const $ = (id) => document.getElementById(id);

  // Run a script whose text lies compressed in the page; its hash is among those that the content policy allows.
  const run = async (id) => {
    const script = document.createElement("script");
    script.textContent = new TextDecoder().decode(await vibroimpact.inflated($(id).textContent));
    document.head.append(script);
    $(id).remove();
  };

  let scene = null;

  const showTheme = (theme, charts) => {
    document.documentElement.dataset.theme = theme;
    vibroimpact.setTheme(theme);
    for (const chart of charts.values()) chart.update();
    scene?.draw();
  };

  const connectViews = (charts) => {
    const select = $("view");
    if (!select) return;
    // long contacts, and those in the middle of many, have no view
    const viewOf = (row) => Array.from(select.options).findIndex((option) => option.text === row.dataset.view) - 1;
    const move = (number) => {
      select.value = String(number);
      for (const chart of charts.values()) if (chart.chart.views.length) chart.update({ view: number < 0 ? null : number, ranges: {} });
      $("view-before").disabled = number < 0;
      $("view-after").disabled = number + 1 >= select.options.length - 1;
      for (const row of document.querySelectorAll("[data-view]")) row.classList.toggle("chosen", number >= 0 && viewOf(row) === number);
      for (const [name, chart] of charts) {
        const words = document.querySelector(`[data-headline="${CSS.escape(name)}"]`);
        if (words) words.textContent = chart.headline;
      }
    };
    select.addEventListener("change", () => move(Number(select.value)));
    $("view-before").addEventListener("click", () => move(Number(select.value) - 1));
    $("view-after").addEventListener("click", () => move(Number(select.value) + 1));
    for (const button of document.querySelectorAll("[data-view] button")) {
      const view = viewOf(button.closest("[data-view]"));
      if (view < 0) button.disabled = true;
      button.addEventListener("click", () => { move(view); $("charts").scrollIntoView(); });
    }
    move(-1);
  };

  const connectKeys = (charts) => {
    for (const select of document.querySelectorAll("select[data-key-of]")) {
      const chart = charts.get(select.dataset.keyOf);
      select.addEventListener("change", () => chart.update({ key: select.value }));
    }
  };

  const connectCopies = () => {
    for (const button of document.querySelectorAll("button[data-copy]")) {
      button.addEventListener("click", async () => {
        const text = $(button.dataset.copy).textContent;
        try { await navigator.clipboard.writeText(text); button.textContent = "Copied"; } catch {
          getSelection().selectAllChildren($(button.dataset.copy));
          button.textContent = "Selected: press Ctrl+C";
        }
      });
    }
  };

  // What a link leads to is opened.
  const connectFolds = () => {
    const open = (hash) => {
      for (let fold = hash && $(decodeURIComponent(hash.slice(1)))?.closest("details"); fold; fold = fold.parentElement.closest("details")) fold.open = true;
    };
    for (const link of document.querySelectorAll('a[href^="#"]')) link.addEventListener("click", () => open(link.hash));
    open(location.hash);
  };

  // On paper: light, with everything open and drawn, as wide as it is there [px]; afterwards as before.
  const connectPaper = (charts) => {
    const COLUMN = 330, PAGE = 680;
    let theme = "light", closed = [];
    addEventListener("beforeprint", () => {
      theme = vibroimpact.theme;
      closed = [...document.querySelectorAll("details:not([open])")];
      for (const part of closed) part.open = true;
      showTheme("light", charts);
      for (const chart of charts.values()) chart.update({ paper: chart.element.closest(".broad") ? PAGE : COLUMN });
    });
    addEventListener("afterprint", () => {
      for (const part of closed) part.open = false;
      for (const chart of charts.values()) chart.update({ paper: null });
      showTheme(theme, charts);
    });
  };

  // A click on a point of a study writes its command below the charts' heading, to be copied.
  const clicked = (point) => {
    const line = $("command");
    if (!line || !point.text) return;
    line.textContent = new DOMParser().parseFromString(point.text.split("<br>").pop(), "text/html").body.textContent;
    line.closest("[hidden]")?.removeAttribute("hidden");
    document.querySelector("button[data-copy=command]").textContent = "Copy";
  };

  const start = async () => {
    const [data] = await Promise.all([vibroimpact.inflated($("data").textContent), run("plotly")]);
    $("data").textContent = "";
    const { charts: given, scene: moving, palette } = vibroimpact.unpack(data);
    vibroimpact.setPalette(palette);
    const charts = new Map();
    for (const chart of given) {
      const element = document.querySelector(`[data-chart="${CSS.escape(chart.name)}"]`);
      if (element) charts.set(chart.name, new vibroimpact.Chart(element, chart, clicked));
    }
    const preferred = matchMedia("(prefers-color-scheme: dark)");
    showTheme(preferred.matches ? "dark" : "light", charts);
    const button = $("theme");
    button.addEventListener("click", () => showTheme(vibroimpact.theme === "dark" ? "light" : "dark", charts));
    connectViews(charts);
    connectKeys(charts);
    connectCopies();
    connectFolds();
    if (moving) scene = vibroimpact.controlScene($("scene"), moving);
    connectPaper(charts);
    vibroimpact.charts = charts;
    await Promise.all([...charts.values()].map((chart) => chart.drawing));
    document.documentElement.dataset.ready = "true";
  };

  start().catch((error) => {
    const notice = $("notice");
    notice.hidden = false;
    notice.textContent = `The charts can't be drawn: ${error.message}`;
    console.error(error);
  });
}
