// 3D view of a packing (packing_view.py): grains and force chains coloured by force, with a slider over its scans.
const wallNames = ['wall x min', 'wall x max', 'wall y min', 'wall y max', 'floor', 'plate'];
const smallGrains = 0.42;  // scale of grains when chains are shown
const axes = ['x', 'y', 'z'];
const centre = (scan, grain) => axes.map(axis => scan[axis + '_mm'][grain]);

class PackingView {
  constructor(id, view) {
    this.view = view;
    this.place = document.getElementById(id);
    const figure = this.place.closest('figure');
    [this.setting, this.what, this.slider, this.output, this.player] =
      ['.setting', '.what', 'input', 'output', '.play'].map(part => figure.querySelector(part));
    for (const {label} of view.settings) this.setting.add(new Option(label));
    this.setting.addEventListener('change', () => { this.limit(); this.draw(); });
    this.what.addEventListener('change', () => this.draw());
    this.slider.addEventListener('input', () => this.draw());
    this.player.addEventListener('click', () => this.play());
    this.limit();
    this.slider.value = this.shown.strongest;
  }

  get shown() { return this.view.settings[this.setting.selectedIndex]; }

  limit() { this.slider.max = this.shown.scans.length - 1; }

  play() {
    const next = () => {
      this.slider.value = (Number(this.slider.value) + 1) % this.shown.scans.length;
      this.draw();
    };
    this.timer = this.timer ? clearInterval(this.timer) : setInterval(next, 400);
    this.player.textContent = this.timer ? 'stop' : 'play';
  }

  /// Sum of the forces on each grain's contacts [mN], and their number.
  loads(scan) {
    const force = new Float64Array(this.shown.number.length), count = new Int32Array(force.length);
    scan.force_mN.forEach((f, c) => {
      for (const grain of [scan.grain[c], scan.partner[c]].filter(grain => grain >= 0)) {
        force[grain] += f;
        ++count[grain];
      }
    });
    return {force, count};
  }

  grains(scan, share) {
    const {points, faces} = this.view.spheres[this.shown.sphere], {force, count} = this.loads(scan);
    const mesh = {x: [], y: [], z: [], i: [], j: [], k: [], intensity: [], text: []};
    this.shown.diameter_mm.forEach((diameter, grain) => {
      const words = `grain ${this.shown.number[grain]}<br>diameter ${diameter.toFixed(2)} mm<br>` +
        `${count[grain]} contacts, forces of ${force[grain].toPrecision(4)} mN together`;
      const at = centre(scan, grain), first = grain * points.length;
      for (const point of points) {
        axes.forEach((axis, a) => mesh[axis].push(at[a] + share * diameter / 2 * point[a]));
        mesh.intensity.push(force[grain]);
        mesh.text.push(words);
      }
      for (const face of faces) ['i', 'j', 'k'].forEach((corner, c) => mesh[corner].push(first + face[c]));
    });
    return {...themed(this.view.grains), ...mesh};
  }

  /// Edges along which the packing repeats, each with its axis.
  edges(scan) {
    const [width, depth] = this.shown.box_mm, [x, y, z, xy, xz, yz] = scan.cell_mm ?? [];
    if (scan.cell_mm) return [[2, [xz, yz, z]], [1, [xy, y, 0]], [0, [x, 0, 0]]];
    return this.shown.container === 'periodic' ? [[1, [0, depth, 0]], [0, [width, 0, 0]]] : [];
  }

  /// End of a contact's line: the centre of the partner's nearest image, or the foot on the wall.
  end(scan, grain, partner) {
    const here = centre(scan, grain), [width, depth] = this.shown.box_mm, wall = -1 - partner;
    if (partner >= 0) {
      const there = centre(scan, partner);
      for (const [axis, edge] of this.edges(scan)) {
        const times = Math.round((there[axis] - here[axis]) / edge[axis]);
        edge.forEach((length, a) => { there[a] -= times * length; });
      }
      return there;
    }
    if (wall === 0 && this.shown.container === 'cylinder') {
      const [x, y] = here.map(at => at - width / 2), out = Math.hypot(x, y);
      return [width / 2 * (1 + x / out), width / 2 * (1 + y / out), here[2]];
    }
    here[wall >> 1] = [0, width, 0, depth, 0, scan.plate_mm][wall];
    return here;
  }

  chains(scan) {
    const {number, container} = this.shown, traces = themed(this.view.chains);
    const nameOf = partner => partner >= 0 ? `grain ${number[partner]}`
      : partner === -1 && container === 'cylinder' ? 'side' : wallNames[-1 - partner];
    const thin = Math.max(0.35, Math.min(1, Math.cbrt(100 / number.length)));  // so that many chains do not hide one another
    for (const trace of traces) {
      Object.assign(trace, {x: [], y: [], z: [], text: []});
      trace.line.width *= thin;
    }
    scan.force_mN.forEach((force, c) => {
      const trace = traces[Math.min(traces.length - 1, Math.floor(force / this.view.force_mN * traces.length))];
      const from = centre(scan, scan.grain[c]), to = this.end(scan, scan.grain[c], scan.partner[c]);
      const words = `grain ${number[scan.grain[c]]} and ${nameOf(scan.partner[c])}<br>${force.toPrecision(4)} mN`;
      axes.forEach((axis, a) => trace[axis].push(from[a], (from[a] + to[a]) / 2, to[a], null));
      trace.text.push(words, words, words, words);
    });
    return traces;
  }

  /// The container's edges and the plate, whose heights are numbered: floor, plate, top.
  walls(scan) {
    const [width, depth] = scan.cell_mm ?? this.shown.box_mm, plate = scan.plate_mm;
    const heights = [0, plate, scan.cell_mm ? plate : this.shown.top_mm];
    return this.shown.walls.map(wall => ({...themed(wall), x: wall.x.map(x => x && x * width), y: wall.y.map(y => y && y * depth),
                                          z: wall.z.map(height => heights[height] ?? null)}));
  }

  /// `width` [pixels]; default: the available width.
  draw(width) {
    const scan = this.shown.scans[this.slider.value], what = this.what.value, traces = this.walls(scan);
    if (what !== 'chains') traces.push(this.grains(scan, what === 'both' ? smallGrains : 1));
    if (what !== 'grains') traces.push(...this.chains(scan));
    const layout = {...themed(this.shown.layout), width}, eye = layout.scene.camera.eye;
    if ((width || this.place.clientWidth) < narrow) for (const axis of axes) eye[axis] *= 1.45;  // otherwise its sides are cut off
    this.output.textContent = scan.title;
    return Plotly.react(this.place, traces, layout, plotSettings);
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
