// Main script: unpacks the plotting library, draws the charts, and draws them again when the theme changes.
const plotSettings = {responsive: true, displaylogo: false, modeBarButtonsToRemove: ['lasso2d', 'select2d']};
const narrow = 640;  // pixels; on narrower pages legends are below the charts

async function unpackedLibrary() {
  const packed = Uint8Array.from(atob(document.getElementById('library').textContent), c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return await new Response(stream).text();
}

const axisLook = {gridcolor: 'var(--grid)', linecolor: 'var(--axis)', tickcolor: 'var(--axis)', showline: true,
                  zeroline: false, automargin: true};

const toolLook = {bgcolor: 'rgba(0,0,0,0)', color: 'var(--line)', activecolor: 'var(--ink)'};

/// The layout of the chart in the style of the page.
function layoutOf(chart, width) {
  const layout = {
    height: chart.height, margin: {l: 60, r: 16, t: 24, b: 48}, paper_bgcolor: 'rgba(0,0,0,0)',
    plot_bgcolor: 'rgba(0,0,0,0)', modebar: toolLook, hovermode: 'closest', font: {family: 'system-ui, sans-serif', size: 13,
    color: 'var(--ink)'}, hoverlabel: {bgcolor: 'var(--card)', bordercolor: 'var(--line)', align: 'left',
    font: {color: 'var(--ink)'}, namelength: -1}, ...chart.layout};
  for (const key of Object.keys(layout).filter(key => /^[xy]axis/.test(key))) {
    const axis = layout[key] = {...axisLook, ...layout[key]};
    if (chart.logged && chart.log.includes(key[0]))
      Object.assign(axis, {type: 'log', dtick: 'D2', rangemode: 'normal', exponentformat: 'power'});
  }
  layout.legend = width < narrow ? {orientation: 'h', y: -0.2, ...layout.legend} : {...layout.legend};
  return layout;
}

function drawChart(chart, width) {
  const place = document.getElementById(chart.id);
  const layout = layoutOf(chart, width || place.clientWidth);
  if (width) layout.width = width;
  return Plotly.react(place, themed(chart.data), themed(layout), plotSettings);
}

function sayTrouble(error) {
  const trouble = document.getElementById('trouble');
  trouble.hidden = false;
  trouble.textContent = `The charts cannot be shown: ${error.message}. They need a browser of 2023 or later.`;
}

function addLogButtons(charts) {
  for (const button of document.querySelectorAll('button[data-log]')) {
    const chart = charts.find(({id}) => id === button.dataset.log);
    button.addEventListener('click', () => {
      chart.logged = !chart.logged;
      button.setAttribute('aria-pressed', chart.logged);
      drawChart(chart);
    });
  }
}

/// The chart in its print version as an SVG file that drawing programs can edit.
function addSvgButtons(charts) {
  for (const button of document.querySelectorAll('button[data-svg]')) {
    const chart = charts.find(({id}) => id === button.dataset.svg);
    button.addEventListener('click', () => {
      const {data, layout} = inTheme('light', () => {
        const width = document.getElementById(chart.id).clientWidth;
        return {data: themed(chart.data), layout: {...themed(layoutOf(chart, width)), width}};
      });
      Plotly.downloadImage({data, layout}, {format: 'svg', filename: chart.id, width: layout.width, height: layout.height});
    });
  }
}

/// For print: light theme and the width of the paper.
function addPrinting(charts, packings, drawAll) {
  const paper = 690;  // width of A4 between its margins in pixels
  let theme;
  addEventListener('beforeprint', () => {
    theme = root.dataset.theme;
    root.dataset.theme = 'light';
    for (const folded of document.querySelectorAll('details')) folded.open = true;
    charts.forEach(chart => drawChart(chart, paper));
    packings.forEach(packing => packing.print(paper));
  });
  addEventListener('afterprint', () => {
    if (theme) root.dataset.theme = theme; else delete root.dataset.theme;
    packings.forEach(packing => packing.printed());
    drawAll();
  });
}

async function showPage() {
  const content = JSON.parse(document.getElementById('content').textContent);
  for (const chart of content.charts) Object.assign(chart, chartOf(chart));
  (0, eval)(await unpackedLibrary());
  const packings = content.packings.map(({id, view}) => new PackingView(id, view));
  const drawAll = () => Promise.all([...content.charts.map(chart => drawChart(chart)),
                                     ...packings.map(packing => packing.draw())]);
  const button = document.getElementById('theme');
  const named = () => { button.textContent = isDark() ? 'bright' : 'dark'; };
  button.addEventListener('click', () => {
    root.dataset.theme = isDark() ? 'light' : 'dark';
    named();
    drawAll();
  });
  screenIsDark.addEventListener('change', () => { named(); drawAll(); });
  named();
  addLogButtons(content.charts);
  addSvgButtons(content.charts);
  addPrinting(content.charts, packings, drawAll);
  await drawAll();
  root.dataset.ready = 'yes';
}

showPage().catch(sayTrouble);
