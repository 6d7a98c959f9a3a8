// Plotly measures the column of a chart before the page is laid out, and again only if the window changes: measure whenever the column does.
addEventListener("load", () => {
  const columns = new ResizeObserver((changed) => changed.forEach(({ target }) => Plotly.Plots.resize(target.querySelector(".js-plotly-plot"))));
  document.querySelectorAll(".plotly-chart").forEach((column) => columns.observe(column));
});
