// Themes (light, dark, print): colours that charts take from the page.
const root = document.documentElement;
const screenIsDark = matchMedia('(prefers-color-scheme: dark)');

function isDark() {
  return root.dataset.theme ? root.dataset.theme === 'dark' : screenIsDark.matches;
}

/// A copy of the charts' data with every "var(--name)" replaced by its present value.
function themed(value, style = getComputedStyle(root)) {
  if (typeof value === 'string' && value.startsWith('var(--'))
    return style.getPropertyValue(value.slice(4, -1)).trim();
  if (Array.isArray(value)) return value.map(part => themed(part, style));
  if (value === null || typeof value !== 'object' || ArrayBuffer.isView(value)) return value;
  return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, themed(part, style)]));
}

/// Result of `work` with that theme, without a visible change.
function inTheme(name, work) {
  const before = root.dataset.theme;
  root.dataset.theme = name;
  try {
    return work();
  } finally {
    if (before) root.dataset.theme = before; else delete root.dataset.theme;
  }
}

/// Colour scale of forces; strong forces have high contrast on light and dark backgrounds.
function forceScale() {
  return isDark()
    ? [[0, '#2f3a46'], [0.15, '#5d4a52'], [0.4, '#b3541e'], [0.7, '#ff9a52'], [1, '#fff1d6']]
    : [[0, '#d8dde3'], [0.15, '#f0cfa4'], [0.4, '#e08530'], [0.7, '#a03c06'], [1, '#3d0b00']];
}

/// The colour at a fraction from 0 to 1 of the scale.
function colourAt(scale, share) {
  const above = Math.max(1, scale.findIndex(([place]) => place >= share));
  const [[from, low], [to, high]] = [scale[above - 1], scale[above]];
  const part = Math.min(1, Math.max(0, (share - from) / (to - from)));
  const channel = at => {
    const [a, b] = [low, high].map(colour => parseInt(colour.slice(at, at + 2), 16));
    return Math.round(a + part * (b - a));
  };
  return `rgb(${channel(1)},${channel(3)},${channel(5)})`;
}
