// Charts in a page: completes the figures of vibroimpact.charts.plotly by what is visible, and draws them by plotly.
"use strict";

{
  const COLUMNS = 700;      // into which a line is divided; up to four points of each are drawn
  const STACK_POINTS = 500;
  const MOST_SPANS = 80;
  const PICTURE_WIDTH = 1000;  // from which on pictures are as high as they can be
  const MOST_NAMES = 24;    // in the legend
  const STACKED = 760;      // width [px] below which panels side by side have no room
  const GAP = 64;           // between panels below each other [px]

  let colours = {};

  // Set the colours of all roles, as vibroimpact.charts.palette gives them.
  vibroimpact.palette = { light: {}, dark: {} };
  vibroimpact.setPalette = (given) => { vibroimpact.palette = given; vibroimpact.setTheme(vibroimpact.theme || "light"); };
  vibroimpact.setTheme = (theme) => { vibroimpact.theme = theme; colours = vibroimpact.palette[theme]; };

  const faded = (colour, opacity) => colour + Math.round(255 * opacity).toString(16).padStart(2, "0");

  // Return a part of a figure with the roles replaced by their colours.
  const coloured = (part) => {
    if (typeof part === "string") return part[0] === "@" && colours[part.slice(1)] ? colours[part.slice(1)] : part;
    if (part === null || typeof part !== "object" || ArrayBuffer.isView(part)) return part;
    if (Array.isArray(part)) return part.map(coloured);
    const found = {};
    for (const [key, value] of Object.entries(part)) if (key !== "fillopacity") found[key] = coloured(value);
    if (part.fillopacity < 1 && found.fillcolor) found.fillcolor = faded(found.fillcolor, part.fillopacity);
    return found;
  };

  const ascends = new WeakMap();
  const isAscending = (x) => {
    if (!ascends.has(x)) {
      let up = x.length > 0;
      for (let index = 1; index < x.length && up; index++) up = x[index] >= x[index - 1];
      ascends.set(x, up);
    }
    return ascends.get(x);
  };

  // Return the first index at which ascending values are at least a value.
  const searched = (values, value) => {
    let low = 0, high = values.length;
    while (low < high) { const middle = (low + high) >> 1; if (values[middle] < value) low = middle + 1; else high = middle; }
    return low;
  };

  const slice = (x, range) => range === null || !isAscending(x)
    ? [0, x.length]
    : [Math.max(searched(x, range[0]) - 1, 0), Math.min(searched(x, range[1]) + 1, x.length)];

  // Return the indices of the visible points of a line: the first, last, lowest and highest in each column, of every part between NaN.
  const visible = (x, y, range) => {
    const [first, last] = slice(x, range);
    if (last - first <= 4 * COLUMNS || !isAscending(x)) return Array.from({ length: last - first }, (_, index) => first + index);
    const found = [];
    const start = x[first], step = (x[last - 1] - start) / COLUMNS;
    const partOf = (index) => (Number.isNaN(y[index]) ? -1 : Math.min(Math.floor((x[index] - start) / step), COLUMNS - 1));
    let index = first;
    while (index < last) {
      const part = partOf(index), begin = index;
      let low = index, high = index;
      for (index++; index < last && partOf(index) === part; index++) {
        if (y[index] < y[low]) low = index;
        if (y[index] > y[high]) high = index;
      }
      const kept = [begin, low, high, index - 1].sort((a, b) => a - b);
      for (const one of kept) if (found[found.length - 1] !== one) found.push(one);
    }
    return found;
  };

  const evenly = (x, range, count) => {
    const [first, last] = slice(x, range);
    if (last - first <= count || !isAscending(x)) return Array.from({ length: last - first }, (_, index) => first + index);
    const found = [];
    for (let number = 0; number < count; number++) {
      const at = Math.min(searched(x, x[first] + (x[last - 1] - x[first]) * number / (count - 1)), last - 1);
      if (found[found.length - 1] !== at) found.push(at);
    }
    return found;
  };

  const shown = (values, frame, indices) => indices
    ? Float64Array.from(indices, (index) => (values[index] - frame.origin) / frame.size)
    : Float64Array.from(values, (value) => (value - frame.origin) / frame.size);

  // What is written at the pointer. Plotly calls what has no name by its number, unless it is told to write nothing.
  const nameOf = (trace) => (trace.name ? "" : "<extra></extra>");
  const hover = (x, y, trace) => `${trace.text ? "%{text}<br>" : ""}%{x:.7~g} ${x.unit}<br>%{y:.5~g} ${y.unit}${nameOf(trace)}`;
  const COMMON = ["xaxis", "yaxis", "name", "showlegend", "legendgroup"];
  const common = (trace) => Object.fromEntries(COMMON.filter((key) => key in trace).map((key) => [key, trace[key]]));

  // Return the points inside a range, so that the vertical axis is theirs.
  const within = (points, range) => {
    const inside = Array.from(points.x.keys()).filter((index) => points.x[index] >= range[0] && points.x[index] <= range[1]);
    const picked = (values) => values && inside.map((index) => values[index]);
    const keys = Object.fromEntries(Object.entries(points.keys || {}).map(([key, values]) => [key, picked(values)]));
    const some = Object.fromEntries(["x", "y", "text", "low", "high"].filter((key) => points[key]).map((key) => [key, picked(points[key])]));
    // without any the legend would lose their name
    return { ...points, ...some, ...(points.keys ? { keys } : {}), ...(inside.length ? {} : { x: [null], y: [null], low: undefined }) };
  };

  const completions = {
    scatter(whole, x, y, range, state) {
      const trace = whole.mode === "markers" && range && ArrayBuffer.isView(whole.x) ? within(whole, range) : whole;
      const { low, high, keys, ...kept } = trace;
      const line = trace.mode === "lines" && trace.fill === undefined;
      const indices = line && ArrayBuffer.isView(trace.x) ? visible(trace.x, trace.y, range) : null;
      kept.x = trace.x[0] === null ? [null] : shown(trace.x, x, indices);
      kept.y = trace.y[0] === null ? [null] : shown(trace.y, y, indices);
      if (indices && trace.text) kept.text = indices.map((index) => trace.text[index]);
      if (low) {
        const reach = (a, b) => Float64Array.from(a, (value, index) => (value - b[index]) / y.size);
        kept.error_y = { array: reach(high, trace.y), arrayminus: reach(trace.y, low), thickness: 1, width: 3, color: "@main" };
      }
      if (trace.hoverinfo !== "skip" && !trace.hovertemplate) kept.hovertemplate = hover(x, y, trace);
      if (keys && keys[state.key]) Object.assign(kept, { showlegend: false, marker: { ...kept.marker, ...state.colouring.marker(keys[state.key]) } });
      return [kept];
    },
    band(trace, x, y, range) {
      const indices = evenly(trace.x, range, 2 * COLUMNS);
      const edge = { ...common(trace), type: "scatter", mode: "lines", hoverinfo: "skip", line: trace.line, x: shown(trace.x, x, indices) };
      const { fillcolor, fillopacity } = trace;
      return [
        { ...edge, y: shown(trace.low, y, indices), showlegend: false },
        { ...edge, y: shown(trace.high, y, indices), fill: "tonexty", fillcolor, fillopacity },
      ];
    },
    stack(trace, x, y, range) {
      const indices = range === null && trace.overview ? Array.from(trace.overview) : evenly(trace.x, range, STACK_POINTS);
      const edge = new Float64Array(indices.length);
      for (const layer of trace.layers) indices.forEach((at, index) => { edge[index] += Math.min(layer.y[at], 0); });
      const line = { ...common(trace), type: "scatter", mode: "lines", x: shown(trace.x, x, indices) };
      const traces = [{ ...line, y: shown(edge, y), line: { width: 0 }, hoverinfo: "skip", showlegend: false }];
      for (const layer of trace.layers) {
        indices.forEach((at, index) => { edge[index] += Math.max(layer.y[at], 0); });
        const { y: values, ...look } = layer;
        const hovertemplate = `${layer.name}: %{customdata:.5~g} ${y.unit}<br>%{x:.7~g} ${x.unit}<extra></extra>`;
        const own = { fill: "tonexty", line: { width: 0.5, color: "@main" }, customdata: shown(values, y, indices), hovertemplate };
        traces.push({ ...line, ...look, ...own, y: shown(edge, y), showlegend: true });
      }
      return traces;
    },
    bars(trace, x, y) {
      const [along, across] = trace.lying ? [y, x] : [x, y];
      const places = shown(trace.places, along), values = Float64Array.from(trace.values, (value) => value / across.size);
      const bar = { ...common(trace), type: "bar", orientation: trace.lying ? "h" : "v", marker: trace.marker };
      bar.width = Float64Array.from(trace.widths, (value) => value / along.size);
      [bar.x, bar.y] = trace.lying ? [values, places] : [places, values];
      if (trace.base) bar.base = shown(trace.base, across);
      if (trace.text) bar.hovertext = trace.text;  // as "text" it would be written on the bars
      const [place, value] = trace.lying ? ["y", "x"] : ["x", "y"];
      const what = trace.text ? "%{hovertext}" : `%{${place}:.5~g} ${along.unit}`;
      bar.hovertemplate = `${what}<br>%{${value}:.5~g} ${across.unit}${nameOf(trace)}`;
      if (trace.low) {
        const reach = (a, b) => Float64Array.from(a, (value, index) => (value - b[index]) / across.size);
        const error = { array: reach(trace.high, trace.values), arrayminus: reach(trace.values, trace.low), thickness: 1, width: 3, color: "@main" };
        bar[trace.lying ? "error_x" : "error_y"] = error;
      }
      return [bar];
    },
    rug: () => [],
    heatmap: (trace, x, y) => [grid(trace, x, y)],
    contour: (trace, x, y) => [grid(trace, x, y)],
  };

  const rows = (values) => Array.from({ length: values.length / values.columns }, (_, row) => values.subarray(row * values.columns, (row + 1) * values.columns));
  const textRows = (texts, columns) => Array.from({ length: texts.length / columns }, (_, row) => texts.slice(row * columns, (row + 1) * columns));
  const grid = (trace, x, y) => ({
    ...trace, x: shown(trace.x, x), y: shown(trace.y, y), z: rows(trace.z), ...(trace.customdata ? { customdata: rows(trace.customdata) } : {}),
    ...(trace.text ? { text: textRows(trace.text, trace.z.columns) } : {}),
  });

  const plain = (words) => words.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");

  // Return how the points of a chart are coloured by a key, alike in all panels: by a scale for numbers, by a colour for each name, which the legend has.
  const colouringBy = (chart, key) => {
    const all = chart.data.filter((trace) => trace.keys && trace.keys[key]).map((trace) => trace.keys[key]);
    if (!all.length) return { legend: [], layout: {} };
    if (typeof all[0][0] === "string") {
      const names = [...new Set(all.flat())];
      const colour = new Map(names.map((name, index) => [name, `@series ${index % 8}`]));
      const entry = { type: "scatter", mode: "markers", x: [null], y: [null], hoverinfo: "skip", showlegend: true };
      const legend = names.slice(0, MOST_NAMES).map((name) => ({ ...entry, name: plain(name), marker: { color: colour.get(name), size: 7 } }));
      return { legend, layout: {}, marker: (values) => ({ color: values.map((name) => colour.get(name)), line: { width: 0 } }) };
    }
    const [cmin, cmax] = all.flatMap((values) => Array.from(values)).reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
    const colorbar = { title: { text: plain(key), side: "right" }, thickness: 12, outlinewidth: 0 };
    const layout = { coloraxis9: { cmin, cmax, colorscale: "Viridis", colorbar } };
    return { legend: [], layout, marker: (values) => ({ color: Array.from(values), coloraxis: "coloraxis9", line: { width: 0 } }) };
  };

  const shapes = (chart, frames, ranges) => {
    const found = [];
    for (const level of chart.levels) {
      const range = ranges[level.axis];
      if (range && (level.value < range[0] || level.value > range[1])) continue;
      const place = shown([level.value], frames[level.axis])[0], side = level.axis[0], other = side === "x" ? "y" : "x";
      const label = { text: level.label, textposition: "end", font: { size: 10 } };
      found.push({
        type: "line", line: level.line, label, [`${side}ref`]: level.axis, [`${side}0`]: place, [`${side}1`]: place,
        [`${other}ref`]: `${level.across} domain`, [`${other}0`]: 0, [`${other}1`]: 1,
      });
    }
    for (const span of chart.spans) {
      const frame = frames[span.axis], range = ranges[span.axis];
      let count = 0;
      for (let index = 0; index < span.starts.length && count < MOST_SPANS; index++) {
        if (range && (span.ends[index] < range[0] || span.starts[index] > range[1])) continue;
        const [x0, x1] = shown([span.starts[index], span.ends[index]], frame);
        const look = { fillcolor: span.fillcolor, opacity: span.opacity, line: { width: 0 }, layer: "below" };
        found.push({ type: "rect", xref: span.axis, x0, x1, yref: `${span.across} domain`, y0: 0, y1: 1, ...look });
        count += 1;
      }
    }
    for (const rug of chart.data.filter((trace) => trace.type === "rug")) {
      const path = Array.from(shown(rug.x, frames[rug.xaxis]), (place) => `M${place},0L${place},0.03`).join("");
      if (path) found.push({ type: "path", path, xref: rug.xaxis, yref: `${rug.yaxis} domain`, line: { color: rug.color, width: 1 } });
    }
    return found;
  };

  // Put pictures into one column, or more than two of them into two, with the colour scale below, for a narrow screen.
  const narrowPictures = (layout, width) => {
    const names = Object.keys(layout).filter((key) => /^xaxis/.test(key)).map((key) => key.slice(5));
    const [x, y] = [layout.xaxis.domain, layout.yaxis.domain];
    const columns = names.length > 2 ? 2 : 1, lines = Math.ceil(names.length / columns), gap = 40, side = columns > 1 ? 0.48 : 1;
    const row = (y[1] - y[0]) * layout.height * side * width / ((x[1] - x[0]) * PICTURE_WIDTH);
    layout.height = lines * row + (lines - 1) * gap;
    names.forEach((name, index) => {
      const top = layout.height - Math.floor(index / columns) * (row + gap), left = index % columns ? 1 - side : 0;
      layout[`xaxis${name}`] = { ...layout[`xaxis${name}`], domain: [left, left + side] };
      layout[`yaxis${name}`] = { ...layout[`yaxis${name}`], domain: [Math.max(0, (top - row) / layout.height), top / layout.height] };
    });
    for (const key of Object.keys(layout).filter((name) => /^coloraxis/.test(name))) {
      const { title, ...bar } = layout[key].colorbar;
      const below = { orientation: "h", x: 0.5, xanchor: "center", y: -10 / layout.height, yanchor: "top", len: 1, title: { ...title, side: "bottom" } };
      layout[key] = { ...layout[key], colorbar: { ...bar, ...below } };
    }
  };

  // Put the panels of a layout below each other.
  const stack = (layout, chart) => {
    const panels = chart.rows.flat();
    layout.height = panels.reduce((sum, [, height]) => sum + height, GAP * (panels.length - 1));
    for (const key of Object.keys(layout).filter((name) => /^[xy]axis/.test(name))) layout[key] = { ...layout[key], domain: [0, 0.001] };
    let top = layout.height;
    for (const [suffix, height] of panels) {
      const domain = [(top - height) / layout.height, top / layout.height];
      Object.assign(layout[`xaxis${suffix}`], { domain: [0, 1] });
      Object.assign(layout[`yaxis${suffix}`], { domain, showticklabels: true });
      const name = chart.bars[suffix];
      if (name) layout[name] = { ...layout[name], colorbar: { ...layout[name].colorbar, x: 1, y: 0.5 * (domain[0] + domain[1]), len: height / layout.height } };
      top -= height + GAP;
    }
  };

  const TICKS = 5;          // of a vertical axis, at least about
  const LETTER = 7;         // width of a figure [px]

  // Return the number of letters of the widest number at an axis from one value to another.
  const lettersAt = (low, high) => {
    const decimals = Math.max(0, -Math.floor(Math.log10((high - low) / TICKS)));
    return Math.max(...[low, high].map((end) => (end < 0 ? 1 : 0) + Math.max(1, Math.floor(Math.log10(Math.abs(end) || 1)) + 1) + (decimals && decimals + 1)));
  };

  // Return the ends of what is drawn at a vertical axis, or of the range to which it was zoomed.
  const endsAt = (name, axis, data) => {
    if (axis.range) return axis.range;
    let [low, high] = [0, 0];
    for (const trace of data) if ((trace.yaxis || "y") === name) for (const value of trace.y) { if (value < low) low = value; if (value > high) high = value; }
    return [low, high];
  };

  const TITLE = 260;        // width that the title of a panel takes beside a legend, at most [px]
  const SYMBOL = 40;        // width of a symbol of a legend [px]

  // Where each row of a single panel names marks of its own, give it a legend beside its title; return whether it is so.
  const giveRowsLegends = (chart, layout, state, data) => {
    if (state.paper || state.width < STACKED || chart.rows.length < 2 || chart.rows.some((row) => row.length !== 1)) return false;
    const named = data.filter((trace) => trace.legendgroup);
    const rows = chart.rows.map(([[suffix]]) => ({ suffix, entries: named.filter((trace) => trace.yaxis === `y${suffix}`) }));
    const groups = rows.map(({ entries }) => [...new Set(entries.map((trace) => trace.legendgroup))]);
    const wide = rows.some(({ entries }) => entries.reduce((sum, trace) => sum + SYMBOL + LETTER * (trace.showlegend ? trace.name.length : -SYMBOL / LETTER), TITLE) > state.width);
    if (wide || groups.some((of) => !of.length) || new Set(groups.flat()).size < groups.flat().length) return false;
    rows.forEach(({ suffix, entries }, row) => {
      const name = row ? `legend${row + 1}` : "legend";
      for (const trace of entries) trace.legend = name;
      layout[name] = { orientation: "h", x: 1, xanchor: "right", y: layout[`yaxis${suffix}`].domain[1] + 2 / layout.height, yanchor: "bottom", font: { size: 11 } };
    });
    return true;
  };

  const layoutOf = (chart, frames, ranges, state, data) => {
    const entries = data.filter((trace) => trace.showlegend === true).length;
    const layout = { ...chart.layout, ...state.colouring.layout };
    const narrow = state.width < 560, reflowed = narrow && chart.pictures && "xaxis2" in layout;
    if (reflowed) narrowPictures(layout, state.width);
    else if (chart.pictures) layout.height *= Math.min(1, state.width / PICTURE_WIDTH);
    else if (state.width < STACKED && chart.rows.some((row) => row.length > 1)) stack(layout, chart);
    if (state.paper) layout.height = Math.round((layout.yaxis.domain[0] > 0 ? 0.85 : 0.7) * layout.height);   // several rows need room for their titles
    const bar = reflowed && "coloraxis" in layout ? 60 : 0;
    let room = chart.pictures ? 8 : narrow ? 48 : 64;
    const grey = { gridcolor: "@grid", linecolor: "@soft", zerolinecolor: "@soft", zerolinewidth: 0.7, ticks: "outside", tickcolor: "@soft", ticklen: 4 };
    for (const key of Object.keys(layout).filter((name) => /^[xy]axis/.test(name))) {
      const name = key.replace("axis", "");
      const frame = frames[name];
      const axis = { ...grey, ...layout[key] };
      if (axis.title.text && frame.title !== chart.frames[name].title) axis.title = { text: frame.title };
      if (ranges[name]) axis.range = ranges[name].map((end) => (end - frame.origin) / frame.size).map((end) => (axis.type === "log" ? Math.log10(end) : end));
      if (axis.type !== "log") axis.exponentformat = "none";
      axis.title = { ...axis.title, font: { size: state.paper ? 10 : 12 }, standoff: state.paper ? 2 : 6 };
      // what plotly measures of letters costs half of a drawing: it is left to axes of names
      const named = Boolean(axis.ticktext);
      Object.assign(axis, { automargin: named, ticklabeloverflow: named ? "hide past div" : "allow" }, named ? {} : { tickangle: 0 });
      layout[key] = axis;
      // the numbers beside the title, at the left edge
      if (key[0] === "y" && !named && !chart.pictures && axis.type !== "log" && (layout[key.replace("y", "x")]?.domain?.[0] || 0) === 0) {
        const [low, high] = endsAt(name, axis, data);
        if (high > low) room = Math.max(room, LETTER * lettersAt(low, high) + (axis.title.text ? 32 : 12));
      }
    }
    const letters = state.paper ? 10 : narrow ? 11 : 13;
    layout.annotations = (layout.annotations || []).map((note) => ({ ...note, font: { ...note.font, size: Math.min(note.font?.size ?? letters, letters) } }));
    layout.shapes = shapes(chart, frames, ranges);
    layout.font = { color: "@ink", family: "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', Arial, sans-serif", size: 12 };
    Object.assign(layout, { paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", hovermode: "closest", bargap: 0.2, barmode: "overlay" });
    layout.hoverlabel = { bgcolor: "@ground", bordercolor: "@soft", font: { color: "@ink" } };
    layout.margin = { l: room, r: narrow ? 8 : 20, t: 30, b: 48 + bar };
    layout.legend = { orientation: "h", x: 0, y: -(chart.pictures ? 20 + bar : 64) / layout.height, yanchor: "top", font: { size: state.paper ? 9 : 11 }, ...(layout.legend || {}) };
    const lines = layout.showlegend && !giveRowsLegends(chart, layout, state, data) ? Math.ceil(entries / Math.max(1, Math.floor(state.width / (state.paper ? 150 : 190)))) : 0;
    // of several rows the legend is ahead of the first one, above the titles of panels
    const above = !chart.pictures && chart.rows.length > 1;
    if (above && lines) Object.assign(layout.legend, { y: 1 + 22 / layout.height, yanchor: "bottom" });
    layout.height += 78 + bar + 22 * lines;
    layout.margin[above ? "t" : "b"] += 22 * lines + (lines ? 12 : 0);
    layout.dragmode = state.touch ? false : "zoom";
    return layout;
  };

  // Return data and layout for plotly of a chart in a state: the number of its view or null, ranges that were zoomed to, a ghost.
  vibroimpact.complete = (chart, given) => {
    const state = { ...given, colouring: colouringBy(chart, given.key) };
    const view = state.view === null || state.view === undefined ? null : chart.views[state.view];
    const frames = { ...chart.frames, ...(view ? view.frames : {}) };
    const ranges = {};
    for (const [name, frame] of Object.entries(view ? view.frames : {})) {
      const before = state.ghost?.views[state.view]?.frames[name];
      const reach = (end) => { const ends = [frame, before].filter((one) => one?.range).map((one) => one.range[end] * one.size); return (end ? Math.max : Math.min)(...ends) + frame.origin; };
      if (frame.range) ranges[name] = [reach(0), reach(1)];   // the ghost's as well
    }
    Object.assign(ranges, state.ranges || {});
    for (const key of Object.keys(chart.layout)) {
      const axis = /^xaxis/.test(key) && chart.layout[key].matches && chart.layout[key].matches;
      if (axis && ranges[axis] && !ranges[key.replace("axis", "")]) ranges[key.replace("axis", "")] = ranges[axis];
    }
    // Return how traces are drawn that count from the origins of some frames, which the view or their own may put elsewhere.
    const drawnFrom = (own) => (trace) => {
      const [x, y] = [frames[trace.xaxis], frames[trace.yaxis]];
      const origin = view && trace.origins ? trace.origins[state.view] : own[trace.xaxis].origin, later = origin - x.origin;
      const range = ranges[trace.xaxis] ? ranges[trace.xaxis].map((end) => end + later) : null;
      return completions[trace.type](trace, { ...x, origin }, { ...y, origin: own[trace.yaxis].origin }, range, state);
    };
    const before = state.ghost && (!view || state.ghost.views[state.view]) ? state.ghost : { data: [] };
    const there = { ...frames, ...before.frames, ...(view ? before.views?.[state.view].frames : {}) };
    const ghosts = before.data.filter((trace) => trace.type === "scatter" && trace.mode === "lines" && trace.fill === undefined && frames[trace.xaxis]);
    const ghost = ghosts.flatMap(drawnFrom(there)).map((trace) => ({ ...trace, line: { color: "@ghost", width: 1.2, dash: "4px,3px" }, opacity: 0.9, showlegend: false, hoverinfo: "skip", hovertemplate: undefined }));
    const data = [...ghost, ...chart.data.flatMap(drawnFrom(frames)), ...state.colouring.legend];
    return coloured({ data, layout: layoutOf(chart, frames, ranges, state, data) });
  };

  // nothing of a chart is offered to be sent anywhere
  const CONFIG = { responsive: false, displaylogo: false, showSendToCloud: false, plotlyServerURL: "", modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"], displayModeBar: "hover", showTips: false, typesetMath: false };

  // Keep a chart in an element of the page: draw it when it is near the window, again after a zoom, and when its width changes.
  vibroimpact.Chart = class {
    // `clicked` is called with a point that is clicked.
    constructor(element, chart, clicked = () => {}) {
      this.element = element;
      this.clicked = clicked;
      this.chart = chart;
      this.state = { view: null, ranges: {}, key: "", ghost: null, paper: null };
      this.near = false;        // to the window, so that it is drawn
      this.seen = false;        // within it, by more than a strip
      this.stale = true;
      this.drawing = null;
      const seen = new IntersectionObserver((entries) => { this.seen = entries[entries.length - 1].isIntersecting; }, { rootMargin: "-60px" });
      const near = new IntersectionObserver((entries) => {
        this.near = entries[entries.length - 1].isIntersecting;
        if (this.near && this.stale) this.draw();
      }, { rootMargin: "200px" });
      const sized = new ResizeObserver(() => { if (Math.abs(element.clientWidth - (this.width || 0)) > 1) this.update(); });
      seen.observe(element);
      near.observe(element);
      sized.observe(element);
      this.end = () => { seen.disconnect(); near.disconnect(); sized.disconnect(); };
    }

    // The view that is shown, if any, and what is to be written above it.
    get view() { return this.chart.views[this.state.view]; }
    get headline() { return this.view ? this.view.name + (this.view.headline && `: ${this.view.headline}`) : ""; }

    // Show another chart, or another state of it; it is drawn when it can be seen, or at once for paper, whose width the state gives.
    update(changes = {}) {
      if (changes.chart) this.chart = changes.chart;
      delete changes.chart;
      Object.assign(this.state, changes);
      if (this.state.view !== null && this.state.view >= this.chart.views.length) this.state.view = null;
      this.stale = true;
      return this.near || this.state.paper ? this.draw() : Promise.resolve();
    }

    // One drawing at a time: what changes meanwhile is drawn when it is done.
    draw() {
      if (this.drawing) return this.drawing;
      this.drawing = (async () => {
        while (this.stale) {
          this.stale = false;
          this.width = this.state.paper || this.element.clientWidth;
          if (!this.width) break;
          Object.assign(this.state, { width: this.width, touch: matchMedia("(pointer: coarse)").matches });
          const { data, layout } = vibroimpact.complete(this.chart, this.state);
          const first = !this.element.classList.contains("js-plotly-plot");
          await Plotly.react(this.element, data, { ...layout, width: this.width }, CONFIG);
          if (first) {
            this.element.on("plotly_relayout", (change) => this.zoomed(change));
            this.element.on("plotly_click", (event) => this.clicked(event.points[0]));
          }
          this.element.style.minHeight = `${layout.height}px`;
        }
      })().finally(() => { this.drawing = null; });
      return this.drawing;
    }

    zoomed(change) {
      const ranges = { ...this.state.ranges };
      let found = false;
      for (const [key, value] of Object.entries(change)) {
        // a whole range comes when the axes are set back
        const match = /^([xy])axis(\d*)\.(range|range\[0\]|autorange)$/.exec(key);
        if (!match) continue;
        const name = match[1] + match[2];
        const frame = { ...this.chart.frames, ...this.view?.frames }[name];
        const ends = [change[`${match[1]}axis${match[2]}.range[0]`], change[`${match[1]}axis${match[2]}.range[1]`]];
        const log = (this.chart.layout[`${match[1]}axis${match[2]}`] || {}).type === "log";
        if (match[3] !== "range[0]") delete ranges[name];
        else ranges[name] = ends.map((end) => (log ? 10 ** end : end) * frame.size + frame.origin);
        found = true;
      }
      if (found) this.update({ ranges });
    }
  };
}
