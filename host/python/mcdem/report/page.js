// Unpacks the plotting library, draws the charts of the page, and draws them again when the theme changes.
const root = document.documentElement;
const screenIsDark = matchMedia('(prefers-color-scheme: dark)');
const plotSettings = {responsive: true, displaylogo: false, modeBarButtonsToRemove: ['lasso2d', 'select2d']};
const narrow = 640;  // pixels; on narrower pages legends are below the charts
const isDark = () => root.dataset.theme ? root.dataset.theme === 'dark' : screenIsDark.matches;

function setTheme(name) {
  if (name) root.dataset.theme = name; else delete root.dataset.theme;
}

/// A copy of the charts' data with every "var(--name)" replaced by its present value.
function themed(value, style = getComputedStyle(root)) {
  if (typeof value === 'string' && value.startsWith('var(--'))
    return style.getPropertyValue(value.slice(4, -1)).trim();
  if (Array.isArray(value)) return value.map(part => themed(part, style));
  if (value === null || typeof value !== 'object') return value;
  return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, themed(part, style)]));
}

async function unpackedLibrary() {
  const packed = Uint8Array.from(atob(document.getElementById('library').textContent), c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return await new Response(stream).text();
}

/// The layout of a chart at this width in the present theme.
function layoutOf(chart, width) {
  const layout = themed(chart.layout);
  for (const key of Object.keys(layout).filter(key => /^[xy]axis/.test(key)))
    if (chart.logged && chart.log.includes(key[0]))
      Object.assign(layout[key], {type: 'log', dtick: 'D2', rangemode: 'normal', exponentformat: 'power'});
  layout.legend = width < narrow ? {orientation: 'h', y: -0.3, ...layout.legend} : {...layout.legend};
  return layout;
}

function drawChart(chart, width) {
  const place = document.getElementById(chart.id), layout = layoutOf(chart, width || place.clientWidth);
  if (width) layout.width = width;
  return Plotly.react(place, themed(chart.data), layout, plotSettings);
}

/// The chart in its print version as an SVG file that drawing programs can edit.
function saveSvg(chart) {
  const before = root.dataset.theme, width = document.getElementById(chart.id).clientWidth;
  setTheme('light');
  const picture = {data: themed(chart.data), layout: {...layoutOf(chart, width), width}};
  setTheme(before);
  Plotly.downloadImage(picture, {format: 'svg', filename: chart.id, width, height: chart.layout.height});
}

function addButtons(charts) {
  for (const chart of charts) {
    const [log, svg] = ['log', 'svg'].map(what => document.querySelector(`button[data-${what}="${chart.id}"]`));
    svg.addEventListener('click', () => saveSvg(chart));
    if (log) log.addEventListener('click', () => {
      chart.logged = !chart.logged;
      log.setAttribute('aria-pressed', chart.logged);
      drawChart(chart);
    });
  }
}

/// For print: light theme and the width of the paper.
function addPrinting(charts, packings, drawAll) {
  const paper = 690;  // width of A4 between its margins in pixels
  let theme;
  addEventListener('beforeprint', () => {
    theme = root.dataset.theme;
    setTheme('light');
    for (const folded of document.querySelectorAll('details')) folded.open = true;
    charts.forEach(chart => drawChart(chart, paper));
    packings.forEach(packing => packing.print(paper));
  });
  addEventListener('afterprint', () => {
    setTheme(theme);
    packings.forEach(packing => packing.printed());
    drawAll();
  });
}

async function showPage() {
  const {charts, packings: views} = JSON.parse(document.getElementById('content').textContent);
  (0, eval)(await unpackedLibrary());
  const packings = views.map(({id, view}) => new PackingView(id, view));
  const drawAll = () => Promise.all([...charts.map(chart => drawChart(chart)), ...packings.map(packing => packing.draw())]);
  const button = document.getElementById('theme');
  const named = () => { button.textContent = isDark() ? 'bright' : 'dark'; };
  const redraw = () => { named(); drawAll(); };
  button.addEventListener('click', () => { setTheme(isDark() ? 'light' : 'dark'); redraw(); });
  screenIsDark.addEventListener('change', redraw);
  matchMedia(`(max-width: ${narrow}px)`).addEventListener('change', drawAll);
  named();
  addButtons(charts);
  addPrinting(charts, packings, drawAll);
  await drawAll();
  root.dataset.ready = 'yes';
}

showPage().catch(error => {
  const trouble = document.getElementById('trouble');
  trouble.hidden = false;
  trouble.textContent = `The charts cannot be shown: ${error.message}. They need a browser of 2023 or later.`;
});
