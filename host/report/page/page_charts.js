// Charts in the terms of plotly.js, of the values that figures for print are drawn of too (figure_values.h,
// diagnosis_values.h). Colours may be the page's variables, "var(--ink)".

/// Escapes a text for places in which plotly.js interprets tags and entities.
function plotText(text) {
  return text.replace(/[\x00-\x1f\x7f]/g, ' ').replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;');
}

/// As %.{digits}g.
function general(value, digits) {
  const [mantissa, exponent] = value.toExponential(digits - 1).split('e');
  if (!(exponent < -4 || exponent >= digits)) return String(Number(value.toPrecision(digits)));
  return `${Number(mantissa)}e${exponent < 0 ? '-' : '+'}${String(Math.abs(exponent)).padStart(2, '0')}`;
}

const titled = text => ({title: {text}});

/// "#rrggbb" as a light fill; the colour of text is not changed.
const faint = colour => colour.startsWith('#') ? colour + '2e' : 'var(--grid)';

/// Outline of the band. On logarithmic axes it must not reach zero, so the lower edge is limited to a third of the value.
function band(name, colour, {x, y, standard_error: error}) {
  const low = y.map((value, i) => value > 0 ? Math.max(value - error[i], value / 3) : value - error[i]);
  return {type: 'scatter', mode: 'lines', name: `${name} ± standard error`, x: [...x, ...[...x].reverse()],
          y: [...y.map((value, i) => value + error[i]), ...low.reverse()], fill: 'toself', fillcolor: faint(colour),
          line: {width: 0}, hoverinfo: 'skip', legendgroup: name, showlegend: false};
}

const colourOf = series => series.is_reference ? 'var(--ink)' : series.colour;

/// A band of one standard error where it is known, and the line (`look` solid or dash) or the points (full or open) over
/// it. `words`: what a point says when pointed at, x and y with their formats and units, " ± error" behind y. `inKey`:
/// whether it has an entry there; all curves of a series come and go with that.
function curveTraces(series, curve, look, words, inKey, name = series.words) {
  const {x, y, standard_error: error} = curve, colour = colourOf(series), text = plotText(name);
  const isLine = look === 'solid' || look === 'dash';
  const hasErrors = x.length > 1 && error.every(value => value !== null);
  const trace = {type: 'scatter', mode: isLine ? 'lines+markers' : 'markers', name: text, x, y, legendgroup: text,
                 showlegend: inKey, hovertemplate: `${words.x}<br>${words.y}${hasErrors ? words.error : ''}`,
                 marker: {color: colour, size: isLine ? 4 : 7, symbol: look === 'open' ? 'circle-open' : 'circle'}};
  if (hasErrors) trace.customdata = error;
  if (hasErrors && !isLine) trace.error_y = {type: 'data', array: error, width: 2, thickness: 1};
  if (isLine) trace.line = {color: colour, width: 2, dash: look};
  return hasErrors && isLine ? [band(text, colour, curve), trace] : [trace];
}

const fromZero = text => ({...titled(text), rangemode: 'tozero'});

function runChart(figure, data) {
  return {data, layout: {xaxis: fromZero(figure.x_label), yaxis: fromZero(figure.y_label)}};
}

/// Loading solid, unloading dashed; the reference as points, filled and open.
function phaseTraces(figure, words, nameOf = series => series.words) {
  return figure.series.flatMap(series => series.curves.flatMap((curve, i) => {
    const loads = curve.phase === 'load';
    const look = series.is_reference ? (loads ? 'full' : 'open') : (loads ? 'solid' : 'dash');
    const named = {...words, x: words.x + (loads ? ', loading' : ', unloading')};
    return curveTraces(series, curve, look, named, i === 0, nameOf(series));
  }));
}

function topForceChart(figure) {
  return runChart(figure, phaseTraces(figure, {x: '%{x:.2f} mm', y: '%{y:.4g} N', error: ' ± %{customdata:.2g} N'}));
}

function distributionChart(figure) {
  const words = {x: '%{x:.4g} mN', y: '%{y:.3g} per mN', error: ' ± %{customdata:.2g}'};
  const chart = runChart(figure, figure.series.flatMap(
    series => curveTraces(series, series.curves[0], series.is_reference ? 'full' : 'solid', words, true)));
  chart.layout.yaxis = {...titled(figure.y_label), type: 'log', dtick: 'D2', exponentformat: 'power'};
  return chart;
}

function coordinationChart(figure) {
  const nameOf = series => series.words + (series.remark ? `, ${series.remark}` : '');
  const words = {x: '%{x:.2f} mm', y: 'Z = %{y:.3f}', error: ' ± %{customdata:.2g}'};
  const chart = runChart(figure, phaseTraces(figure, words, nameOf));
  chart.layout.yaxis = titled(figure.y_label);
  return chart;
}

/// Points of loading (filled) and unloading (open), and the line through the origin.
function scalingTraces(series) {
  const words = {x: '%{x:.4g} mN m', y: '%{y:.4g} N', error: ' ± %{customdata:.2g} N'}, name = plotText(series.words);
  const points = series.curves.flatMap(
    (curve, i) => curveTraces(series, curve, curve.phase === 'load' ? 'full' : 'open', words, i === 0));
  const end = Math.max(0, ...series.curves.flatMap(({x}) => x)), first = end / 1000;  // not zero: that has no logarithm
  return [...points, {type: 'scatter', mode: 'lines', x: [first, end], y: [series.slope * first, series.slope * end],
                      line: {color: colourOf(series), width: 1}, legendgroup: name, showlegend: false, name,
                      hovertemplate: `slope ${general(series.slope * 1e3, 4)} /m`}];
}

/// Of a programme: one line through its scans.
function programmeChart(figure, kind) {
  const withUnit = (format, label) => `${format} ${(label.match(/\[([^[]*)\]/) || ['', ''])[1]}`.trimEnd();
  const words = {x: withUnit('%{x:.4g}', figure.x_label), y: withUnit('%{y:.4g}', figure.y_label),
                 error: withUnit(' ± %{customdata:.2g}', figure.y_label)};
  const chart = runChart(figure, figure.series.flatMap(
    series => curveTraces(series, series.curves[0], 'solid', words, true)));
  if (kind === 'cell_coordination') for (const axis of ['xaxis', 'yaxis']) delete chart.layout[axis].rangemode;
  return chart;
}

/// Columns of the trace: those of the map, and an empty one (-1) between the phases.
function gridOf(columns) {
  const edges = [], places = [];
  columns.forEach(({x}, c) => {
    const left = x - 0.5;
    if (c > 0 && left > edges[edges.length - 1]) { edges.push(left); places.push(-1); }
    if (c === 0) edges.push(left);
    edges.push(left + 1);
    places.push(c);
  });
  return {edges, places};
}

/// Blue: the experiment is lower; orange: it is higher.
const gapColours = [[0, 'var(--cool-3)'], [0.2, 'var(--cool-2)'], [0.375, 'var(--cool-1)'], [0.5, 'var(--none)'],
                    [0.625, 'var(--warm-1)'], [0.8, 'var(--warm-2)'], [1, 'var(--warm-3)']];

/// A panel's cells as a trace, `axis` "" or "2".
function cellsTrace(map, panel, axis) {
  const {edges, places} = gridOf(map.columns);
  const empty = () => map.observables.map(() => places.map(() => null)), z = empty(), words = empty();
  for (const cell of panel.cells) {
    const {phase, displacement_mm: displacement} = map.columns[cell.column], place = places.indexOf(cell.column);
    const when = phase === 'whole cycle' ? 'both phases' : phase;
    z[cell.row][place] = cell.z_score;
    words[cell.row][place] = plotText(`${map.observables[cell.row]}, ${when} at ${displacement.toFixed(2)} mm`) +
      `<br>${cell.z_score.toFixed(2)} sigma`;
  }
  return {type: 'heatmap', name: panel.words, x: edges, y0: 0, dy: 1, z, text: words, hoverinfo: 'text', xaxis: `x${axis}`,
          zmin: -map.colour_range, zmax: map.colour_range, xgap: 1, ygap: 1, colorscale: gapColours, showscale: !axis,
          colorbar: {thickness: 12, lenmode: 'pixels', len: 360, y: 1, yanchor: 'top', outlinewidth: 0,
                     title: {text: map.colour_label, side: 'right', font: {size: 12}}}};
}

/// Frames of the cells that stand out, and a trace of their numbers where those find room.
function addFrames(map, panel, axis, {data, layout}) {
  const framed = panel.cells.filter(cell => cell.stands_out), middle = cell => map.columns[cell.column].x;
  for (const cell of framed)
    layout.shapes.push({type: 'rect', xref: `x${axis}`, yref: 'y', x0: middle(cell) - 0.47, x1: middle(cell) + 0.47,
                        y0: cell.row - 0.45, y1: cell.row + 0.45, line: {width: 1.3, color: 'var(--ink)'}});
  if (!framed.length || map.columns.length > 16) return;
  const ink = ({z_score: z}) => Math.abs(z) > 0.6 * map.colour_range ? 'var(--on-strong)' : '#111111';
  data.push({type: 'scatter', mode: 'text', x: framed.map(middle), y: framed.map(cell => cell.row),
             text: framed.map(({z_score: z}) => z.toFixed(Math.abs(z) < 10 ? 1 : 0)),
             textfont: {size: 10, color: framed.map(ink)}, hoverinfo: 'skip', showlegend: false, xaxis: `x${axis}`});
}

function columnsAxis(map, domain) {
  const every = Math.floor(map.columns.length / 10) + 1;  // more labels would overlap
  const shown = map.columns.filter((_, c) => c % every === 0);
  return {domain, range: [-0.02, map.width + 0.02], tickvals: shown.map(({x}) => x),
          ticktext: shown.map(column => general(column.displacement_mm, 3)), showgrid: false, showline: false,
          tickfont: {size: 11}, tickangle: 0, fixedrange: true, title: {text: map.x_label, font: {size: 12}}};
}

/// The panel's heading, and its phases.
function headings(map, heading, xref) {
  const above = (text, x, yshift, size) => ({text, xref, x, yref: 'paper', y: 1, yshift, showarrow: false,
                                             xanchor: 'center', yanchor: 'bottom', font: {size}});
  const all = [above(heading, map.width / 2, 22, 14)];
  for (let first = 0, last; first < map.columns.length; first = last + 1) {
    const {phase} = map.columns[first];
    for (last = first; map.columns[last + 1]?.phase === phase;) ++last;
    const words = phase === 'whole cycle' ? phase : `${phase} →`;
    all.push(above(plotText(words), (map.columns[first].x + map.columns[last].x) / 2, 3, 12));
  }
  return all;
}

function whereChart(map) {
  const rows = map.observables.length;
  const chart = {data: [], layout: {
    margin: {l: 60, r: 16, t: 64, b: 56}, shapes: [], annotations: [], xaxis: columnsAxis(map, [0, 0.485]),
    xaxis2: columnsAxis(map, [0.515, 1]),
    yaxis: {tickvals: map.observables.map((_, r) => r), ticktext: map.observables.map(plotText), range: [rows - 0.5, -0.5],
            showgrid: false, showline: false, ticks: '', fixedrange: true}}};
  map.panels.forEach((panel, p) => {
    const axis = p ? '2' : '';
    chart.data.push(cellsTrace(map, panel, axis));
    addFrames(map, panel, axis, chart);
    chart.layout.annotations.push(...headings(map, panel.words, `x${axis}`));
  });
  return chart;
}

/// A column of text next to the axes, one text per row.
function wordsColumn(heading, words, x, xanchor) {
  const place = (text, y, yref, yshift) => ({text, xref: 'paper', x, xanchor, yref, y, yshift, showarrow: false,
                                             font: {size: 12}});
  return [place(heading, 1, 'paper', 12), ...words.map((text, i) => place(plotText(text), i, 'y', 0))];
}

function whichChart({rows, colour_named: named, colour_other: other, gain_label: gain}) {
  const at = rows.map((row, i) => ({...row, i})), colours = list => list.map(row => row.is_named ? named : other);
  const hover = row => `${plotText(row.words)}<br>${plotText(row.amplitude)}<br>gain ${row.gain === null ? 'nan' : row.gain.toFixed(2)}, ` +
    `probability ${row.probability}, ${row.explained} of chi-square`;
  const scored = at.filter(row => row.gain !== null), confirmed = at.filter(row => row.gain_simulated !== null);
  const limited = at.filter(row => 'over_limit' in row), y = list => list.map(row => row.i);
  const axis = (text, domain) => ({domain, title: {text, font: {size: 12}}, showline: false});
  const line = (x, dash) => ({type: 'line', xref: 'x2', yref: 'paper', x0: x, x1: x, y0: 0, y1: 1,
                              line: {width: 1, dash, color: 'var(--axis)'}});
  return {
    data: [
      {type: 'bar', name: gain, orientation: 'h', x: scored.map(row => row.gain), y: y(scored), hovertext: scored.map(hover),
       hoverinfo: 'text', text: scored.map(row => row.gain.toFixed(1)), textposition: 'auto',
       insidetextfont: {color: '#111111'}, insidetextanchor: 'start', cliponaxis: false, marker: {color: colours(scored)},
       showlegend: false},
      {type: 'scatter', mode: 'markers', name: 'full simulations', x: confirmed.map(row => row.gain_simulated),
       y: y(confirmed), marker: {symbol: 'diamond-open', size: 10, color: 'var(--ink)', line: {width: 1.5}},
       hovertemplate: 'full simulations: gain %{x:.2f}<extra></extra>', showlegend: false},
      {type: 'scatter', mode: 'markers', name: 'fitted amplitude over detection limit', x: limited.map(row => row.over_limit),
       y: y(limited), xaxis: 'x2', error_x: {type: 'data', array: limited.map(row => row.half_interval),
                                             color: 'var(--soft)', width: 3, thickness: 1.2},
       marker: {color: colours(limited), size: 8}, text: limited.map(hover), hoverinfo: 'text', showlegend: false}],
    layout: {
      margin: {l: 60, r: 16, t: 44, b: 56}, bargap: 0.3, xaxis: axis(gain, [0, 0.3]),
      annotations: [...wordsColumn('group', rows.map(row => row.group), -0.005, 'right'),
                    ...wordsColumn('amplitude', rows.map(row => row.amplitude), 0.61, 'left'),
                    ...wordsColumn('probability', rows.map(row => row.probability), 1, 'right')],
      xaxis2: axis('amplitude / limit', [0.37, 0.58]),
      yaxis: {tickvals: y(at), ticktext: rows.map(row => `${plotText(row.words)}        `), range: [rows.length - 0.4, -0.6],
              showgrid: false, showline: false, ticks: ''},
      shapes: [line(0, 'solid'), line(1, 'dash')]}};
}

function howFarChart(forces) {
  const trace = (y, name, mode, color, dash) => ({
    type: 'scatter', mode, name: plotText(name), x: forces.x, y, line: {color, width: 2, dash}, marker: {color, size: 7},
    hovertemplate: '%{x:.2f} mm<br>%{y:.4g} N'});
  const layout = {xaxis: titled(forces.x_label), yaxis: fromZero(forces.y_label), legend: {x: 0.02, y: 0.98}};
  if (forces.fitted)
    layout.shapes = [{type: 'rect', xref: 'x', yref: 'paper', layer: 'below', x0: forces.fitted[0], x1: forces.fitted[1],
                      y0: 0, y1: 1, fillcolor: 'var(--card)', line: {width: 0}}];
  return {layout, data: [trace(forces.before, forces.words_before, 'lines', forces.colour_before, 'dash'),
                         trace(forces.after, forces.words_after, 'lines', forces.colour_after, 'solid'),
                         trace(forces.experiment, 'experiment', 'markers', 'var(--ink)', 'solid')]};
}

function gapLeftChart({bars, gap_label: label}) {
  const places = bars.map((_, i) => i);
  return {
    data: [{type: 'bar', orientation: 'h', x: bars.map(bar => bar.gap_left), y: places,
            marker: {color: bars.map(bar => bar.colour)},
            error_x: {type: 'data', symmetric: false, color: 'var(--ink)', width: 4, thickness: 1.5,
                      array: bars.map(bar => bar.interval ? bar.interval[1] - bar.gap_left : null),
                      arrayminus: bars.map(bar => bar.interval ? bar.gap_left - bar.interval[0] : null)},
            hovertemplate: '%{x:.1f} %<extra></extra>'}],
    layout: {bargap: 0.35, xaxis: fromZero(label),
             yaxis: {tickvals: places, ticktext: bars.map(bar => `${bar.words}: ${bar.gap_left.toFixed(0)} %`),
                     range: [bars.length - 0.4, -0.6], showgrid: false, ticks: ''}}};
}

const chartsByKind = {
  top_force: topForceChart, force_distribution: distributionChart, coordination: coordinationChart,
  scaling: figure => runChart(figure, figure.series.flatMap(scalingTraces)), where: whereChart, which: whichChart,
  how_far: howFarChart, gap_left: gapLeftChart};

/// Data and layout; of the kinds that have no function of their own, figures of programmes.
function chartOf({kind, values}) {
  return (chartsByKind[kind] || programmeChart)(values, kind);
}
