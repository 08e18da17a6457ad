// 3D view of a packing: grains and force chains coloured by force, with a slider over its scans.
const wallNames = ['wall x min', 'wall x max', 'wall y min', 'wall y max', 'floor', 'plate'];
const widths = [1, 1.5, 2.5, 4, 6, 9];  // of force chains by class [pixels]
const smallGrains = 0.42;               // scale of grains when chains are shown

/// The unit sphere as triangles: an icosahedron whose triangles are divided into four, `times` times.
function sphereMesh(times) {
  const t = (1 + Math.sqrt(5)) / 2;
  let points = [[-1, t, 0], [1, t, 0], [-1, -t, 0], [1, -t, 0], [0, -1, t], [0, 1, t], [0, -1, -t], [0, 1, -t],
                [t, 0, -1], [t, 0, 1], [-t, 0, -1], [-t, 0, 1]];
  let faces = [[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2],
               [10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11],
               [6, 2, 10], [8, 6, 7], [9, 8, 1]];
  for (let n = 0; n < times; ++n) {
    const middles = new Map();
    const middle = (a, b) => {
      const key = a < b ? `${a} ${b}` : `${b} ${a}`;
      if (!middles.has(key)) middles.set(key, points.push(points[a].map((c, i) => (c + points[b][i]) / 2)) - 1);
      return middles.get(key);
    };
    faces = faces.flatMap(([a, b, c]) => {
      const [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
      return [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]];
    });
  }
  return {points: points.map(p => { const length = Math.hypot(...p); return p.map(c => c / length); }), faces};
}

class PackingView {
  constructor(id, view) {
    this.view = view;
    this.place = document.getElementById(id);
    const figure = this.figure = this.place.closest('figure');
    [this.setting, this.what, this.slider, this.output, this.player] =
      ['.setting', '.what', 'input', 'output', '.play'].map(part => figure.querySelector(part));
    for (const {label} of view.settings) this.setting.add(new Option(label));
    this.setting.addEventListener('change', () => this.choose());
    this.what.addEventListener('change', () => this.draw());
    this.slider.addEventListener('input', () => this.draw());
    this.player.addEventListener('click', () => this.play());
    this.choose(false);
  }

  get shown() { return this.view.settings[this.setting.selectedIndex]; }

  choose(draw = true) {
    this.slider.max = this.shown.scans.length - 1;
    if (!draw) this.slider.value = this.shown.strongest;
    const grains = this.shown.diameter_mm.length;
    this.sphere = sphereMesh(grains <= 200 ? 2 : grains <= 5000 ? 1 : 0);
    if (draw) this.draw();
  }

  play() {
    if (this.timer) {
      clearInterval(this.timer);
      this.timer = null;
    } else {
      this.timer = setInterval(() => {
        this.slider.value = (Number(this.slider.value) + 1) % this.shown.scans.length;
        this.draw();
      }, 400);
    }
    this.player.textContent = this.timer ? 'stop' : 'play';
  }

  /// Sum of the forces on each grain's contacts [mN], and their number.
  loads(scan) {
    const force = new Float64Array(this.shown.diameter_mm.length), count = new Int32Array(force.length);
    scan.force_mN.forEach((f, c) => {
      for (const grain of [scan.grain[c], scan.partner[c]])
        if (grain >= 0) {
          force[grain] += f;
          ++count[grain];
        }
    });
    return {force, count};
  }

  grains(scan, share) {
    const {points, faces} = this.sphere, n = this.shown.diameter_mm.length;
    const {force, count} = this.loads(scan);
    const mesh = {x: [], y: [], z: [], i: [], j: [], k: [], intensity: [], text: []};
    for (let grain = 0; grain < n; ++grain) {
      const radius = share * this.shown.diameter_mm[grain] / 2, first = grain * points.length;
      const words = `grain ${this.shown.number[grain]}<br>diameter ${this.shown.diameter_mm[grain].toFixed(2)} mm<br>` +
        `${count[grain]} contacts, forces of ${force[grain].toPrecision(4)} mN together`;
      for (const point of points) {
        mesh.x.push(scan.x_mm[grain] + radius * point[0]);
        mesh.y.push(scan.y_mm[grain] + radius * point[1]);
        mesh.z.push(scan.z_mm[grain] + radius * point[2]);
        mesh.intensity.push(force[grain]);
        mesh.text.push(words);
      }
      for (const [a, b, c] of faces) {
        mesh.i.push(first + a);
        mesh.j.push(first + b);
        mesh.k.push(first + c);
      }
    }
    return {type: 'mesh3d', name: 'grains', ...mesh, colorscale: forceScale(), cmin: 0, cmax: this.view.load_mN,
            hoverinfo: 'text', flatshading: false, lighting: {ambient: 0.55, diffuse: 0.65, specular: 0.12,
            roughness: 0.7}, lightposition: {x: 2000, y: -4000, z: 9000}, showscale: true,
            colorbar: {title: {text: 'forces on a grain [mN]', side: 'right'}, thickness: 12, len: 0.75,
                       outlinewidth: 0}};
  }

  /// Centre of the partner; in a periodic cell that of its nearest image.
  image(scan, grain, partner) {
    const there = [scan.x_mm[partner], scan.y_mm[partner], scan.z_mm[partner]];
    if (this.shown.container === 'cell') {
      const [x, y, z, xy, xz, yz] = scan.cell_mm, here = [scan.x_mm, scan.y_mm, scan.z_mm].map(of => of[grain]);
      [[xz, yz, z], [xy, y, 0], [x, 0, 0]].forEach((edge, n) => {
        const axis = 2 - n, times = Math.round((there[axis] - here[axis]) / edge[axis]);
        edge.forEach((length, a) => { there[a] -= times * length; });
      });
      return there;
    }
    if (this.shown.container !== 'periodic') return there;
    const here = [scan.x_mm[grain], scan.y_mm[grain]];
    this.shown.box_mm.forEach((size, a) => { there[a] -= size * Math.round((there[a] - here[a]) / size); });
    return there;
  }

  /// End of a contact's line: the partner's centre, or the foot on the wall.
  end(scan, grain, partner) {
    if (partner >= 0) return this.image(scan, grain, partner);
    const [width, depth] = this.shown.box_mm, wall = -1 - partner;
    const foot = [scan.x_mm[grain], scan.y_mm[grain], scan.z_mm[grain]];
    if (wall === 0 && this.shown.container === 'cylinder') {
      const out = Math.hypot(foot[0] - width / 2, foot[1] - width / 2);
      return [0, 1].map(a => width / 2 * (1 + (foot[a] - width / 2) / out)).concat(foot[2]);
    }
    foot[wall >> 1] = [0, width, 0, depth, 0, scan.plate_mm][wall];
    return foot;
  }

  chains(scan) {
    const scale = forceScale(), classes = widths.length, largest = this.view.force_mN;
    const number = this.shown.number;
    const thin = Math.max(0.35, Math.min(1, Math.cbrt(100 / number.length)));  // so that many chains do not hide one another
    const traces = widths.map((width, c) => ({
      type: 'scatter3d', mode: 'lines', name: 'force chains', x: [], y: [], z: [], text: [], hoverinfo: 'text',
      showlegend: false, line: {width: thin * width, color: colourAt(scale, (c + 0.5) / classes)}, connectgaps: false}));
    scan.force_mN.forEach((force, c) => {
      const trace = traces[Math.min(classes - 1, Math.floor(force / largest * classes))];
      const grain = scan.grain[c], partner = scan.partner[c];
      const from = [scan.x_mm[grain], scan.y_mm[grain], scan.z_mm[grain]], to = this.end(scan, grain, partner);
      const words = `grain ${number[grain]} and ` +
        (partner < 0 ? this.wallName(-1 - partner) : `grain ${number[partner]}`) + `<br>${force.toPrecision(4)} mN`;
      for (const share of [0, 0.5, 1, null]) {
        ['x', 'y', 'z'].forEach((axis, a) => trace[axis].push(share === null ? null : from[a] + share * (to[a] - from[a])));
        trace.text.push(words);
      }
    });
    return traces;
  }

  wallName(wall) { return wall === 0 && this.shown.container === 'cylinder' ? 'side' : wallNames[wall]; }

  /// The outline of floor and plate.
  outline(scan) {
    const [width, depth] = scan.cell_mm ?? this.shown.box_mm, sides = 64;
    if (this.shown.container !== 'cylinder') return [[0, 0], [width, 0], [width, depth], [0, depth]];
    return Array.from({length: sides}, (_, n) => [Math.cos, Math.sin].map(f => width / 2 * (1 + f(2 * Math.PI * n / sides))));
  }

  /// The container's edges and the plate.
  walls(scan) {
    const plate = scan.plate_mm, top = scan.cell_mm ? plate : this.shown.top_mm;
    const edges = {x: [], y: [], z: []};
    const stroke = points => points.concat([[null, null, null]]).forEach(([x, y, z]) => {
      edges.x.push(x);
      edges.y.push(y);
      edges.z.push(z);
    });
    const corners = this.outline(scan), fan = corners.slice(2).map((_, n) => n + 1);
    const uprights = corners.filter((_, n) => n % (corners.length / 4) === 0);
    for (const height of [0, plate]) stroke([...corners, corners[0]].map(([x, y]) => [x, y, height]));
    for (const [x, y] of uprights) stroke([[x, y, 0], [x, y, top]]);
    const box = {type: 'scatter3d', mode: 'lines', ...edges, name: 'box', hoverinfo: 'skip', showlegend: false,
                 line: {width: 2, color: 'var(--axis)'}};
    return scan.cell_mm ? [box] : [
      box,
      {type: 'mesh3d', name: 'plate', x: corners.map(c => c[0]), y: corners.map(c => c[1]), z: corners.map(() => plate),
       i: fan.map(() => 0), j: fan, k: fan.map(n => n + 1), color: 'var(--soft)', opacity: 0.18, hoverinfo: 'skip', showscale: false}];
  }

  layout() {
    const axis = title => ({title: {text: title}, gridcolor: 'var(--grid)', showbackground: false, zeroline: false,
                            showspikes: false, nticks: 5, color: 'var(--axis)'});
    const [width, depth] = this.shown.box_mm;
    const past = 0.1 * Math.max(...this.shown.diameter_mm);  // grains overlap walls and would be cut off at the ends of the axes
    const tall = this.shown.top_mm / Math.cbrt(width * depth * this.shown.top_mm);
    const spans = [width, depth, this.shown.top_mm].map(length => length + 2 * past), mean = Math.cbrt(spans[0] * spans[1] * spans[2]);
    const far = Math.min(1.2, Math.max(0.8, tall / 1.3));
    return {margin: {l: 0, r: 0, t: 0, b: 0}, paper_bgcolor: 'rgba(0,0,0,0)', modebar: toolLook, uirevision: 'kept',
            font: {family: 'system-ui, sans-serif', size: 12, color: 'var(--ink)'},
            hoverlabel: {bgcolor: 'var(--card)', bordercolor: 'var(--line)', font: {color: 'var(--ink)'}, align: 'left'},
            // not from the drawn data: contacts in a periodic cell extend beyond it
            scene: {aspectmode: 'manual', aspectratio: {x: spans[0] / mean, y: spans[1] / mean, z: spans[2] / mean}, uirevision: 'kept', camera: {eye: {x: 1.2 * far, y: -1.95 * far, z: 0.55 * far},
                    center: {x: 0, y: 0, z: -0.08}},
                    xaxis: {...axis('x [mm]'), range: [-past, width + past]},
                    yaxis: {...axis('y [mm]'), range: [-past, depth + past]},
                    zaxis: {...axis('z [mm]'), range: [-past, this.shown.top_mm + past]}}};
  }

  traces() {
    const scan = this.shown.scans[this.slider.value], what = this.what.value;
    const drawn = themed(this.walls(scan));
    if (what !== 'chains') drawn.push(this.grains(scan, what === 'both' ? smallGrains : 1));
    if (what !== 'grains') drawn.push(...this.chains(scan));
    return drawn;
  }

  /// `width` [pixels]; default: the available width.
  draw(width) {
    this.output.textContent = this.shown.scans[this.slider.value].title;
    return Plotly.react(this.place, this.traces(), {...themed(this.layout()), width}, plotSettings);
  }

  /// Browsers do not print WebGL reliably, so it is replaced by a copy on a 2D canvas.
  print(width) {
    this.draw(width);
    const {glplot} = this.place._fullLayout.scene._scene, canvas = glplot.canvas;
    glplot.redraw();
    this.copy = document.createElement('canvas');
    Object.assign(this.copy, {width: canvas.width, height: canvas.height});
    this.copy.style.cssText = canvas.style.cssText;
    this.copy.getContext('2d').drawImage(canvas, 0, 0);
    canvas.after(this.copy);
    canvas.style.visibility = 'hidden';
  }

  printed() {
    this.copy.previousSibling.style.visibility = '';
    this.copy.remove();
  }
}
