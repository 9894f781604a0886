// The page: what its buttons, keys and clicks do, and the loop that draws.
import * as THREE from 'three';

import { obeyAddress } from './address';
import { watchClicks } from './clicks';
import { colorChoices, hasContacts } from './coloring';
import { Commands } from './commands';
import type { FrameSource } from './data';
import { element, showMessage } from './elements';
import { Film } from './film';
import { Grab } from './grab';
import { hasJoints } from './joints';
import { LiveSource } from './live';
import { LiveClock } from './live_clock';
import { Overlays, type Chosen } from './overlays';
import { Panel } from './panel';
import { Probe } from './probe';
import { openRuns } from './recorded';
import { Stage, THEMES } from './stage';
import { Tether } from './tether';
import { Timeline, type Clock } from './timeline';
import { Worlds, momentOf } from './worlds';

const TABLE_MS = 120; // from one writing of the table to the next
const WAIT_MS = 250; // how long a picture stays while the next frames are decoded
const MARKS = ['trails', 'anchors', 'centers', 'bounds', 'contacts'] as const; // of overlays
const SOFTWARE_SHADOWS = 3000; // shapes that still have shadows without a graphics card

export class App {
  readonly stage: Stage;
  worlds!: Worlds;
  overlays!: Overlays;
  panel!: Panel;
  readonly timeline: Clock;
  readonly grab: Grab | null = null; // of a live page, as the next
  private readonly commands: Commands | null = null;
  chosen: Chosen = { cell: -1, row: -1 };
  following = false;
  private readonly lastPlace = new THREE.Vector3();
  private readonly tether = new Tether();
  dirty = true;
  private lastTable = 0;
  private lastDrawn = 0;
  private ghosts = false;
  private theme: 'light' | 'dark' = 'light';
  readonly script: number[] = []; // ms, of the last frames

  constructor(private readonly title: string, readonly sources: FrameSource[], readonly live: LiveSource | null) {
    const planar = sources[0].run.space === 'planar';
    const canvas = element<HTMLCanvasElement>('view');
    this.timeline = live !== null ? new LiveClock(live) : new Timeline(sources, () => { this.dirty = true; });
    if (live !== null) this.grab = new Grab(this, live, canvas); // before the camera hears of a pointer
    this.stage = new Stage(canvas, planar);
    this.stage.controls.addEventListener('change', () => { this.dirty = true; });
    this.setUp(planar);
    if (live !== null) {
      this.commands = new Commands(this, live);
      live.changed = () => { this.dirty = true; };
      live.resized = () => this.build();
    }
    this.setTheme(window.matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
  }

  async begin(): Promise<void> {
    const wanted = new URLSearchParams(window.location.hash.slice(1));
    const time = Number(wanted.get('time') ?? 0);
    if (Number.isFinite(time)) this.timeline.seek(time); // before anything is drawn
    // Of pictures and films: nothing but the worlds and their name, and no frame but those that are asked for.
    const film = wanted.has('film');
    if (film) for (const id of ['panel', 'buttons']) element(id).hidden = true;
    document.documentElement.classList.toggle('film', film);
    element('timeline').hidden = film || (this.live === null && this.timeline.end === 0); // a single moment has none
    await this.prepare(this.timeline.time);
    this.resize();
    this.build();
    this.worlds.read(this.timeline.time);
    if (this.worlds.instances > SOFTWARE_SHADOWS && this.stage.software) element('shadows').click();
    this.showAll(false);
    const refused = obeyAddress(this, wanted, false);
    if (film) {
      if (refused.length > 0) throw new Error(refused.join('; '));
      this.stage.endFlight();
      // Whoever looks on chooses nothing.
      this.worlds.selected = -1;
      this.overlays.axes = false;
      return;
    }
    this.complain(refused);
    window.addEventListener('hashchange', () => {
      this.complain(obeyAddress(this, new URLSearchParams(window.location.hash.slice(1))));
    });
    window.addEventListener('resize', () => {
      this.resize();
      if (this.chosen.cell < 0) this.showAll(false);
    });
    requestAnimationFrame((now) => this.tick(now));
    if (this.timeline.end > 0 && !wanted.has('time') && !window.matchMedia('(prefers-reduced-motion: reduce)').matches) this.timeline.play(true);
  }

  private complain(refused: string[]): void {
    showMessage(refused.length === 0 ? '' : ['Invalid options in the address of this page:', ...refused].join('\n'), true);
  }

  // Frames of pictures and films; how long worlds go on, s.
  film(): Promise<number> {
    return Film.open(this);
  }

  // Until drawAt can draw that time, s.
  async prepare(time: number): Promise<void> {
    await Promise.all(this.sources.flatMap((source) => {
      const { frame, part } = momentOf(source, time);
      return part > 0 ? [source.prepare(frame), source.prepare(frame + 1)] : [source.prepare(frame)];
    }));
  }

  drawAt(time: number): void {
    this.timeline.seek(time);
    this.lastTable = -Infinity; // what is written beside it is of that time, too
    if (!this.draw(performance.now())) throw new Error(`${time} s was not prepared`);
  }

  private build(): void {
    if (this.worlds !== undefined) {
      this.stage.scene.remove(this.worlds.group, this.overlays.group);
      this.worlds.dispose();
      this.overlays.dispose();
    }
    const { width, height } = this.canvasSize();
    this.worlds = new Worlds(this.sources, this.ghosts, width / height, {
      wireframe: this.checked('wireframe'), walls: this.checked('walls'), edges: this.checked('edges'), joints: this.checked('joints'),
    });
    this.worlds.coloring.by = element<HTMLSelectElement>('color').value;
    this.panel = new Panel(this.title, this.sources, this.worlds, (row) => this.choose(this.chosen.cell, row));
    this.worlds.setTheme(THEMES[this.theme]);
    this.overlays = new Overlays(this.worlds);
    for (const id of MARKS) this.overlays[id] = this.checked(id);
    this.stage.scene.add(this.worlds.group, this.overlays.group);
    this.worlds.selected = this.worlds.focus = this.chosen.cell;
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
    for (const [value, text] of colorChoices(this.sources)) color.add(new Option(text, value));
    (element('contacts').parentElement as HTMLElement).hidden = !hasContacts(this.sources);
    color.onchange = () => {
      this.worlds.coloring.by = color.value;
      this.lastTable = -Infinity; // the legend goes with it
      this.dirty = true;
      color.blur();
    };
    const joints = hasJoints(this.sources.map((source) => source.run));
    for (const id of ['joints', 'anchors']) (element(id).parentElement as HTMLElement).hidden = !joints;
    element('compare-row').hidden = this.sources.length < 2;
    const compare = element<HTMLSelectElement>('compare');
    compare.onchange = () => {
      this.ghosts = compare.value === 'ghosts';
      this.choose(-1, -1);
      this.build();
      this.showAll(false);
      compare.blur();
    };
    for (const id of ['edges', 'walls', 'wireframe', 'joints']) element(id).onchange = () => this.build();
    element('shadows').onchange = () => {
      this.stage.shadows = this.checked('shadows');
      this.dirty = true;
    };
    for (const id of MARKS) {
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
    watchClicks(this, element('view'));
  }

  private key(event: KeyboardEvent, togglePanel: (open: boolean) => void): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typing = event.target instanceof HTMLSelectElement ||
      (event.target instanceof HTMLInputElement && event.target.type !== 'checkbox' && event.target.type !== 'range');
    if (typing) return;
    const toggle = (id: string) => element(id).click();
    const actions: Record<string, () => void> = {
      ' ': () => this.timeline.play(!this.timeline.playing),
      ArrowLeft: () => (event.shiftKey ? this.timeline.jump(-1) : this.timeline.step(-1)),
      ArrowRight: () => (event.shiftKey ? this.timeline.jump(1) : this.timeline.step(1)),
      Home: () => this.timeline.seek(0),
      End: () => this.timeline.seek(this.timeline.end),
      '[': () => this.timeline.faster(-1),
      ']': () => this.timeline.faster(1),
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
      b: () => toggle('bounds'),
      x: () => toggle('contacts'),
      j: () => toggle('joints'),
      d: () => toggle('dark'),
      r: () => (this.commands !== null ? this.commands.reset() : toggle('loop')),
      o: () => togglePanel(element('panel').classList.contains('closed')),
    };
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (action === undefined) return;
    event.preventDefault();
    action();
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
    if (cell >= 0 && cell !== this.chosen.cell) this.tether.hold(this.worlds, cell);
    this.panel.chose(cell !== this.chosen.cell);
    this.chosen = { cell, row };
    this.worlds.selected = this.worlds.focus = cell;
    if (row < 0) this.follow(false);
    else if (this.following) this.worlds.placeOf(cell, row, this.lastPlace);
    element('world').hidden = cell < 0;
    this.lastTable = -Infinity;
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

  showCell(cell: number): void {
    this.resize();
    this.stage.show(this.tether.begin(this.worlds, cell), { fly: true, elevation: 0.55 });
  }

  // Chooses a body and goes with it.
  showBody(cell: number, row: number): void {
    this.resize();
    this.choose(cell, row);
    this.stage.show(this.tether.around(this.worlds, cell, row), { fly: true, elevation: 0.55 });
    this.follow(true);
  }

  setTheme(name: 'light' | 'dark'): void {
    this.theme = name;
    document.documentElement.classList.toggle('dark', name === 'dark');
    element<HTMLInputElement>('dark').checked = name === 'dark';
    this.stage.setTheme(name);
    this.worlds?.setTheme(THEMES[name]);
    this.dirty = true;
  }

  redraw(): void {
    this.dirty = true;
  }

  // ---- the loop

  private tick(now: number): void {
    requestAnimationFrame((next) => this.tick(next));
    const began = performance.now();
    this.timeline.advance(now);
    if (this.stage.flying) this.dirty = true;
    if (!this.dirty) return;
    this.dirty = !this.draw(now);
    this.commands?.update();
    this.live?.ask();
    this.script.push(performance.now() - began);
    if (this.script.length > 240) this.script.shift();
  }

  // False: frames are still being decoded, what was there before is drawn.
  draw(now: number): boolean {
    const whole = this.worlds.read(this.timeline.time);
    if (!whole && now - this.lastDrawn < WAIT_MS) return false;
    this.lastDrawn = now;
    this.worlds.widenScales();
    if (this.following) {
      const place = this.worlds.placeOf(this.chosen.cell, this.chosen.row, new THREE.Vector3());
      this.stage.shift(place.clone().sub(this.lastPlace));
      this.lastPlace.copy(place);
    }
    if (this.chosen.cell >= 0) {
      const by = this.tether.pull(this.worlds, this.chosen.cell);
      if (!this.following && this.grab?.dragging !== true) this.stage.shift(by);
    }
    this.stage.advance(now);
    this.stage.camera.updateMatrixWorld();
    this.worlds.write(this.stage.camera, this.stage.pixelsPerMetre);
    this.overlays.pull = this.grab?.line() ?? null;
    this.overlays.update(this.chosen);
    const { layout } = this.worlds;
    this.stage.render(Math.max(layout.width, layout.depth),
      Math.hypot(layout.box.high[0] - layout.box.low[0], layout.box.high[1] - layout.box.low[1]));
    this.tell(now);
    return whole;
  }

  tell(now: number): void {
    this.timeline.tell();
    if (now - this.lastTable < TABLE_MS) return;
    this.lastTable = now;
    this.panel.tellAbout();
    this.panel.legend.tell(this.worlds.coloring);
    if (this.chosen.cell >= 0) this.panel.tellWorld(this.chosen, this.following);
  }
}

declare global {
  interface Window {
    manyworlds?: Probe;
    manyworldsReady?: Promise<App>;
    manyworldsFilm?: Film;
  }
}

async function main(): Promise<App> {
  const live = document.getElementById('mw-live') !== null ? await LiveSource.open() : null;
  const { title, sources } = live !== null ? { title: live.run.title, sources: [live] } : await openRuns(document);
  const app = new App(title, sources, live);
  await app.begin();
  window.manyworlds = new Probe(app);
  return app;
}

window.manyworldsReady = main();
window.manyworldsReady.catch((error: unknown) => {
  showMessage(error instanceof Error ? error.message : String(error), false);
  console.error(error);
});
