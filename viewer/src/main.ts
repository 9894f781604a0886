// The page: what its buttons, keys and clicks do, and the loop that draws.
import * as THREE from 'three';

import { scaleGradient } from './colors';
import { speedOf, type FrameSource } from './data';
import { Overlays, type Chosen } from './overlays';
import { openRuns } from './recorded';
import { Stage, THEMES } from './stage';
import { Worlds, momentOf } from './worlds';

function element<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const TABLE_MS = 120; // from one writing of the table to the next
const CLICK_PIXELS = 5;
const WAIT_MS = 250; // how long a picture stays while the next frames are decoded
const SOFTWARE_SHADOWS = 3000; // shapes that still have shadows without a graphics card

class App {
  readonly stage: Stage;
  worlds!: Worlds;
  private overlays!: Overlays;
  private time = 0;
  private readonly end: number;
  private playing = false;
  private speed = 1;
  private chosen: Chosen = { cell: -1, row: -1 };
  private following = false;
  private readonly lastPlace = new THREE.Vector3();
  private dirty = true;
  private lastTick = 0;
  private lastTable = 0;
  private lastDrawn = 0;
  private ghosts = false;
  private theme: 'light' | 'dark' = 'light';
  private readonly script: number[] = []; // ms, of the last frames

  constructor(private readonly title: string, private readonly sources: FrameSource[]) {
    const planar = sources[0].run.space === 'planar';
    this.end = Math.max(...sources.map((source) => source.time(source.frames - 1)));
    this.stage = new Stage(element<HTMLCanvasElement>('view'), planar);
    this.stage.controls.addEventListener('change', () => { this.dirty = true; });
    this.setUp(planar);
    this.setTheme(window.matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
  }

  async begin(): Promise<void> {
    const wanted = new URLSearchParams(window.location.hash.slice(1));
    const time = Number(wanted.get('time') ?? 0);
    if (Number.isFinite(time)) this.seek(time);
    // A picture: nothing but the worlds and their name.
    if (wanted.has('picture')) for (const id of ['panel', 'buttons', 'timeline']) element(id).hidden = true;
    await Promise.all(this.sources.map((source) => source.prepare(momentOf(source, this.time).frame)));
    this.resize();
    this.build();
    if (this.worlds.instances > SOFTWARE_SHADOWS && this.stage.software) element('shadows').click();
    this.showAll(false);
    this.obey(wanted);
    window.addEventListener('resize', () => {
      this.resize();
      if (this.chosen.cell < 0) this.showAll(false);
    });
    requestAnimationFrame((now) => this.tick(now));
    if (this.end > 0 && !wanted.has('time') && !window.matchMedia('(prefers-reduced-motion: reduce)').matches) this.play(true);
  }

  // What the address asks for: page.html#time=2.5&world=3&color=speed.
  private obey(wanted: URLSearchParams): void {
    const color = wanted.get('color');
    const choice = element<HTMLSelectElement>('color');
    if (color !== null && [...choice.options].some((option) => option.value === color)) {
      choice.value = color;
      choice.dispatchEvent(new Event('change'));
    }
    const cell = Number(wanted.get('world') ?? -1);
    if (Number.isInteger(cell) && cell >= 0 && cell < this.worlds.layout.cells.length) {
      this.choose(cell, -1);
      this.showCell(cell);
    }
  }

  private build(): void {
    if (this.worlds !== undefined) {
      this.stage.scene.remove(this.worlds.group, this.overlays.group);
      this.worlds.dispose();
    }
    const { width, height } = this.canvasSize();
    this.worlds = new Worlds(this.sources, this.ghosts, width / height, {
      wireframe: this.checked('wireframe'), walls: this.checked('walls'), edges: this.checked('edges'),
    });
    this.worlds.colorBy = element<HTMLSelectElement>('color').value;
    this.worlds.setTheme(THEMES[this.theme]);
    this.overlays = new Overlays(this.worlds);
    this.overlays.trails = this.checked('trails');
    this.overlays.joints = this.checked('joints');
    this.overlays.centers = this.checked('centers');
    this.stage.scene.add(this.worlds.group, this.overlays.group);
    this.worlds.selected = this.chosen.cell;
    this.dirty = true;
  }

  private checked(id: string): boolean {
    return element<HTMLInputElement>(id).checked;
  }

  private canvasSize(): { width: number; height: number } {
    return { width: window.innerWidth, height: window.innerHeight };
  }

  private resize(): void {
    const { width, height } = this.canvasSize();
    this.stage.resize(width, height);
    const panel = element('panel');
    const open = !panel.classList.contains('closed') && !panel.hidden;
    const timeline = element('timeline');
    const below = timeline.hidden ? height - 4 : timeline.getBoundingClientRect().top;
    const narrow = width <= 620;
    this.stage.insets = {
      top: element('head').getBoundingClientRect().bottom + 8, left: 12,
      right: open && !narrow ? panel.offsetWidth + 28 : 12,
      bottom: height - (open && narrow ? panel.getBoundingClientRect().top : below) + 8,
    };
    this.dirty = true;
  }

  // ---- what buttons and keys do

  private setUp(planar: boolean): void {
    document.title = `${this.title} – manyworlds`;
    element('title').textContent = this.title;
    const color = element<HTMLSelectElement>('color');
    const choices: [string, string][] = [['body', 'body'], ['speed', 'speed'], ['spin', 'rate of rotation'], ['rest', 'rest and motion'], ['height', 'height']];
    if (this.sources.length > 1) choices.push(['run', 'recording']);
    for (const number of this.sources[0].run.numbers) choices.push([`number:${number.name}`, number.name]);
    for (const [value, text] of choices) color.add(new Option(text, value));
    color.onchange = () => {
      this.worlds.colorBy = color.value;
      this.dirty = true;
      color.blur();
    };
    element('compare-row').hidden = this.sources.length < 2;
    const compare = element<HTMLSelectElement>('compare');
    compare.onchange = () => {
      this.ghosts = compare.value === 'ghosts';
      this.choose(-1, -1);
      this.build();
      this.showAll(false);
      compare.blur();
    };
    for (const id of ['edges', 'walls', 'wireframe']) element(id).onchange = () => this.build();
    element('shadows').onchange = () => {
      this.stage.shadows = this.checked('shadows');
      this.dirty = true;
    };
    for (const id of ['trails', 'joints', 'centers'] as const) {
      element(id).onchange = () => {
        this.overlays[id] = this.checked(id);
        this.dirty = true;
      };
    }
    element('dark').onchange = () => this.setTheme(this.checked('dark') ? 'dark' : 'light');
    for (const id of ['shadows', 'walls', 'edges']) {
      (element(id).parentElement as HTMLElement).hidden = planar;
    }
    if (planar) document.querySelectorAll<HTMLElement>('.z').forEach((cell) => { cell.hidden = true; });
    element('play').onclick = () => this.play(!this.playing);
    element('back').onclick = () => this.step(-1);
    element('on').onclick = () => this.step(1);
    const slider = element<HTMLInputElement>('time');
    slider.max = String(this.end);
    slider.oninput = () => {
      this.play(false);
      this.seek(Number(slider.value));
    };
    const speed = element<HTMLSelectElement>('speed');
    speed.onchange = () => {
      this.speed = Number(speed.value);
      speed.blur();
    };
    element('overview').onclick = () => {
      this.choose(-1, -1);
      this.showAll(true);
    };
    const panelButton = element('panel-button');
    const togglePanel = (open: boolean) => {
      element('panel').classList.toggle('closed', !open);
      panelButton.setAttribute('aria-expanded', String(open));
      this.resize();
      if (this.chosen.cell < 0 && this.worlds !== undefined) this.showAll(true);
    };
    panelButton.onclick = () => togglePanel(element('panel').classList.contains('closed'));
    if (window.innerWidth <= 620) element('panel').classList.add('closed');
    window.addEventListener('keydown', (event) => this.key(event, togglePanel));
    this.setUpPointer();
  }

  private setUpPointer(): void {
    const canvas = element<HTMLCanvasElement>('view');
    let down: { x: number; y: number } | null = null;
    canvas.addEventListener('pointerdown', (event) => {
      down = { x: event.clientX, y: event.clientY };
    });
    canvas.addEventListener('pointerup', (event) => {
      if (down === null || Math.hypot(event.clientX - down.x, event.clientY - down.y) > CLICK_PIXELS) return;
      this.click(event.clientX, event.clientY);
    });
  }

  private click(x: number, y: number): void {
    const ray = this.stage.ray(x, y);
    const body = this.worlds.pick(ray);
    const cell = body?.cell ?? this.worlds.pickCell(ray);
    if (cell < 0) return;
    const other = cell !== this.chosen.cell;
    this.choose(cell, body?.row ?? -1);
    if (other) this.showCell(cell);
  }

  private key(event: KeyboardEvent, togglePanel: (open: boolean) => void): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typing = event.target instanceof HTMLSelectElement ||
      (event.target instanceof HTMLInputElement && event.target.type !== 'checkbox' && event.target.type !== 'range');
    if (typing) return;
    const toggle = (id: string) => element(id).click();
    const actions: Record<string, () => void> = {
      ' ': () => this.play(!this.playing),
      ArrowLeft: () => (event.shiftKey ? this.jump(-1) : this.step(-1)),
      ArrowRight: () => (event.shiftKey ? this.jump(1) : this.step(1)),
      Home: () => this.seek(0),
      End: () => this.seek(this.end),
      '[': () => this.faster(-1),
      ']': () => this.faster(1),
      Escape: () => { this.choose(-1, -1); this.showAll(true); },
      f: () => this.follow(!this.following),
      n: () => this.next(1, () => true),
      p: () => this.next(-1, () => true),
      l: () => this.next(1, (cell) => this.worlds.isLost(this.worlds.layout.cells[cell])),
      c: () => {
        const color = element<HTMLSelectElement>('color');
        color.selectedIndex = (color.selectedIndex + 1) % color.options.length;
        color.dispatchEvent(new Event('change'));
      },
      t: () => toggle('trails'),
      w: () => toggle('wireframe'),
      d: () => toggle('dark'),
      o: () => togglePanel(element('panel').classList.contains('closed')),
    };
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (action === undefined) return;
    event.preventDefault();
    action();
  }

  play(on: boolean): void {
    if (on && this.time >= this.end) this.seek(0);
    this.playing = on;
    const button = element('play');
    button.textContent = on ? '❚❚' : '▶';
    button.setAttribute('aria-label', on ? 'Pause' : 'Play');
    this.lastTick = performance.now();
  }

  seek(time: number): void {
    this.time = Math.max(0, Math.min(this.end, time));
    this.dirty = true;
  }

  private longest(): FrameSource {
    return this.sources.reduce((a, b) => (b.time(b.frames - 1) > a.time(a.frames - 1) ? b : a));
  }

  step(frames: number): void {
    this.play(false);
    const source = this.longest();
    let frame = 0;
    while (frame + 1 < source.frames && source.time(frame + 1) <= this.time + 1e-9) ++frame;
    const between = this.time - source.time(frame) > 1e-9;
    const to = frames < 0 && between ? frame : frame + frames;
    this.seek(source.time(Math.max(0, Math.min(source.frames - 1, to))));
  }

  private jump(seconds: number): void {
    this.seek(this.time + seconds);
  }

  private faster(by: number): void {
    const at = Math.max(0, Math.min(SPEEDS.length - 1, SPEEDS.indexOf(this.speed) + by));
    this.speed = SPEEDS[at];
    element<HTMLSelectElement>('speed').value = String(this.speed);
  }

  private next(by: number, wanted: (cell: number) => boolean): void {
    const count = this.worlds.layout.cells.length;
    for (let k = 1; k <= count; ++k) {
      const cell = (((this.chosen.cell + by * k) % count) + count) % count;
      if (!wanted(cell)) continue;
      this.choose(cell, -1);
      this.showCell(cell);
      return;
    }
  }

  choose(cell: number, row: number): void {
    this.chosen = { cell, row };
    this.worlds.selected = cell;
    if (row < 0) this.follow(false);
    else if (this.following) this.worlds.placeOf(cell, row, this.lastPlace);
    element('world').hidden = cell < 0;
    element('bodies').replaceChildren();
    this.lastTable = 0;
    this.dirty = true;
  }

  follow(on: boolean): void {
    this.following = on && this.chosen.row >= 0;
    if (this.following) this.worlds.placeOf(this.chosen.cell, this.chosen.row, this.lastPlace);
    this.dirty = true;
  }

  private showAll(fly: boolean): void {
    const count = this.worlds.layout.cells.length;
    this.stage.show(this.worlds.layout.box, { fly, elevation: count > 12 ? 0.85 : count > 1 ? 0.6 : 0.38, yaw: count > 12 ? 0.14 : count > 1 ? 0.22 : 0.38 });
    this.dirty = true;
  }

  private showCell(cell: number): void {
    const { layout } = this.worlds;
    const one = layout.cells[cell];
    this.resize();
    this.stage.show({
      low: [one.x + layout.low[0], one.y + layout.low[1], layout.low[2]],
      high: [one.x + layout.high[0], one.y + layout.high[1], layout.high[2]],
    }, { fly: true, elevation: 0.55 });
  }

  private setTheme(name: 'light' | 'dark'): void {
    this.theme = name;
    document.documentElement.classList.toggle('dark', name === 'dark');
    element<HTMLInputElement>('dark').checked = name === 'dark';
    this.stage.setTheme(name);
    this.worlds?.setTheme(THEMES[name]);
    this.dirty = true;
  }

  // ---- the loop

  private tick(now: number): void {
    requestAnimationFrame((next) => this.tick(next));
    const began = performance.now();
    if (this.playing) {
      this.seek(this.time + ((now - this.lastTick) / 1000) * this.speed);
      if (this.time >= this.end) this.play(false);
    }
    this.lastTick = now;
    if (this.stage.flying) this.dirty = true;
    if (!this.dirty) return;
    this.dirty = !this.draw(now);
    this.script.push(performance.now() - began);
    if (this.script.length > 240) this.script.shift();
  }

  // False: frames are still being decoded, what was there before is drawn.
  draw(now: number): boolean {
    const whole = this.worlds.read(this.time);
    if (!whole && now - this.lastDrawn < WAIT_MS) return false;
    this.lastDrawn = now;
    this.worlds.widenScales();
    if (this.following) {
      const place = this.worlds.placeOf(this.chosen.cell, this.chosen.row, new THREE.Vector3());
      this.stage.shift(place.clone().sub(this.lastPlace));
      this.lastPlace.copy(place);
    }
    this.stage.advance(now);
    this.stage.camera.updateMatrixWorld();
    this.worlds.write(this.stage.camera, this.stage.pixelsPerMetre);
    this.overlays.update(this.chosen);
    const { layout } = this.worlds;
    this.stage.render(Math.max(layout.width, layout.depth),
      Math.hypot(layout.box.high[0] - layout.box.low[0], layout.box.high[1] - layout.box.low[1]));
    this.tell(now);
    return whole;
  }

  private tell(now: number): void {
    element<HTMLInputElement>('time').value = String(this.time);
    element('clock').textContent = `${this.time.toFixed(2)} / ${this.end.toFixed(2)} s`;
    if (now - this.lastTable < TABLE_MS) return;
    this.lastTable = now;
    this.tellAbout();
    this.tellLegend();
    if (this.chosen.cell >= 0) this.tellWorld();
  }

  private tellAbout(): void {
    const { cells } = this.worlds.layout;
    const lost = cells.filter((cell) => this.worlds.isLost(cell)).length;
    const about = element('about');
    const names = [...new Set(this.sources.flatMap((source) => source.run.kinds.map((kind) => kind.scene)))];
    about.replaceChildren(`${cells.length} ${cells.length === 1 ? 'world' : 'worlds'}${names.length > 0 && names.join() !== this.title ? ` of ${names.join(', ')}` : ''}, ${this.worlds.instances.toLocaleString('en')} shapes`);
    if (lost > 0) {
      const mark = document.createElement('span');
      mark.className = 'lost';
      mark.textContent = `, ${lost} lost`;
      about.append(mark);
    }
    about.title = this.sources.map((source) => source.run.origin).join('\n');
  }

  private tellLegend(): void {
    const by = this.worlds.colorBy;
    const scale = element('scale');
    let ends = ['', ''];
    if (by === 'speed') ends = ['0', `${this.worlds.maxSpeed.toPrecision(3)} m/s`];
    else if (by === 'spin') ends = ['0', `${this.worlds.maxSpin.toPrecision(3)} rad/s`];
    else if (by === 'height') {
      const up = this.worlds.planar ? 1 : 2;
      ends = [this.worlds.layout.low[up], this.worlds.layout.high[up]].map((x) => `${x.toPrecision(3)} m`);
    } else if (by.startsWith('number:')) {
      const unit = this.sources[0].run.numbers.find((one) => `number:${one.name}` === by)?.unit ?? '';
      ends = this.worlds.numberEnds.map((x) => `${x.toPrecision(3)} ${unit}`);
    }
    const scaled = ends[1] !== '';
    if (by === 'rest') ends = ['at rest', 'moving'];
    if (by === 'run') ends = ['first', 'second'];
    scale.style.background = scaled ? scaleGradient
      : by === 'rest' ? 'linear-gradient(90deg, #5b6f8f 50%, #f3a712 50%)'
        : by === 'run' ? 'linear-gradient(90deg, #3f6fb5 50%, #f3a712 50%)' : '';
    element('legend').hidden = by === 'body';
    element('low').textContent = ends[0];
    element('high').textContent = ends[1];
  }

  private tellWorld(): void {
    const { cell: index, row: chosenRow } = this.chosen;
    const cell = this.worlds.layout.cells[index];
    const kind = this.worlds.kindOf(cell);
    const run = this.worlds.runOf(cell);
    const poses = this.worlds.posesOf(cell);
    const recording = this.sources.length > 1 ? `, recording ${cell.run + 1}` : '';
    element('world-name').textContent = `World ${kind.names[cell.world]}${recording}`;
    const status = poses.status[cell.world];
    const words = ['not finite, frozen', 'out of range, frozen', 'out of bounds', 'out of contact capacity', 'a joint broke', 'gained energy']
      .filter((_, bit) => (status >> bit) & 1);
    const followed = this.following ? ', followed' : '';
    element('world-about').textContent = `${kind.scene}: ${words.length > 0 ? words.join(', ') : 'ok'}${followed}`;
    const bodies = element('bodies');
    const moving = kind.bodies.map((body, b) => ({ body, b })).filter(({ body }) => body.row !== null);
    while (bodies.children.length < moving.length) {
      const line = document.createElement('tr');
      for (let c = 0; c < 6; ++c) line.append(document.createElement('td'));
      const row = moving[bodies.children.length].body.row as number;
      line.onclick = () => this.choose(this.chosen.cell, row);
      bodies.append(line);
    }
    moving.forEach(({ body, b }, i) => {
      const line = bodies.children[i] as HTMLTableRowElement;
      const row = body.row as number;
      const item = cell.world * kind.rows + row;
      line.classList.toggle('chosen', row === chosenRow);
      const dot = document.createElement('span');
      dot.className = 'dot';
      dot.style.background = `rgb(${this.worlds.colorOf(index, row).join()})`;
      line.cells[0].replaceChildren(dot, body.name || `body ${b}`);
      line.cells[0].title = `${body.name || `body ${b}`}, ${body.mass.toPrecision(3)} kg`;
      const there = poses.there[item] !== 0;
      [poses.position[3 * item], poses.position[3 * item + 1], poses.position[3 * item + 2],
        speedOf(run, poses.speed[item]), speedOf(run, poses.spin[item])].forEach((x, c) => {
        const text = there ? x.toFixed(2) : '–';
        if (line.cells[c + 1].textContent !== text) line.cells[c + 1].textContent = text;
      });
      if (this.worlds.planar) line.cells[3].hidden = true;
    });
  }

  // ---- for tests and for those who drive the page from elsewhere

  get report() {
    const median = (values: number[]) => [...values].sort((a, b) => a - b)[values.length >> 1] ?? 0;
    return {
      instances: this.worlds.instances,
      drawn: this.worlds.drawn,
      worlds: this.worlds.layout.cells.length,
      frames: this.sources.map((source) => source.frames),
      time: this.time,
      frame: this.worlds.frame,
      playing: this.playing,
      speed: this.speed,
      chosen: { ...this.chosen },
      following: this.following,
      drawCalls: this.worlds.objects + this.overlays.objects,
      allCalls: this.stage.renderer.info.render.calls,
      triangles: this.stage.renderer.info.render.triangles,
      scriptMs: median(this.script),
      waiting: this.dirty,
      flying: this.stage.flying,
    };
  }

  // ms of script for each of so many frames, one after the other and without GL: reading frames,
  // writing instances, what is written beside the picture.
  async measure(frames: number): Promise<number[]> {
    const out: number[] = [];
    for (let i = 0; i < frames; ++i) {
      const time = (this.end * (i + 0.5)) / frames;
      await Promise.all(this.sources.map(async (source) => {
        for (let frame = 0; frame < source.frames; ++frame) await source.prepare(frame);
      }));
      const began = performance.now();
      this.time = time;
      this.worlds.read(time);
      this.worlds.widenScales();
      this.worlds.write(this.stage.camera, this.stage.pixelsPerMetre);
      this.overlays.update(this.chosen);
      this.tell(began);
      out.push(performance.now() - began);
    }
    this.dirty = true;
    return out;
  }

  bodyAt(cell: number, row: number) {
    const place = this.worlds.placeOf(cell, row, new THREE.Vector3());
    const one = this.worlds.layout.cells[cell];
    const poses = this.worlds.posesOf(one);
    const item = one.world * this.worlds.kindOf(one).rows + row;
    return {
      pixel: this.stage.pixelOf(place), color: this.worlds.colorOf(cell, row),
      position: [...poses.position.subarray(3 * item, 3 * item + 3)],
      rotation: [...poses.rotation.subarray(4 * item, 4 * item + 4)],
    };
  }

  // What is drawn at a place of the canvas: red, green, blue.
  pixelAt(x: number, y: number): number[] {
    this.draw(performance.now());
    const { renderer } = this.stage;
    const gl = renderer.getContext();
    const ratio = renderer.getPixelRatio();
    const out = new Uint8Array(4);
    gl.readPixels(Math.round(x * ratio), Math.round(gl.drawingBufferHeight - y * ratio), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
    return [...out.subarray(0, 3)];
  }
}

declare global {
  interface Window {
    manyworlds?: App;
  }
}

async function main(): Promise<void> {
  const { title, sources } = await openRuns(document);
  const app = new App(title, sources);
  await app.begin();
  window.manyworlds = app;
}

main().catch((error: unknown) => {
  const message = element('message');
  message.hidden = false;
  message.textContent = error instanceof Error ? error.message : String(error);
  console.error(error);
});
