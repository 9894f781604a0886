// Commands of a live page, and messages of its program.
import * as THREE from 'three';

import type { App } from './main';
import { element, showMessage } from './elements';
import type { LiveSource } from './live';

const COUNTS = [1, 4, 16, 64, 256, 1024];

export class Commands {
  private sliders = ''; // owner of the sliders

  constructor(private readonly app: App, private readonly source: LiveSource) {
    element('live').hidden = false;
    const { can } = source.run;
    const reset = element<HTMLButtonElement>('live-reset');
    reset.hidden = !can.resets;
    reset.onclick = () => this.reset();
    element('live-save').onclick = () => source.link.send({ do: 'save' });
    const push = element<HTMLInputElement>('live-push');
    push.oninput = () => {
      app.grab!.pushSpeed = Number(push.value);
      element('live-push-value').textContent = `${push.value} m/s`;
    };
    push.oninput(new Event('input'));
    this.setUpWorlds();
    this.setUpParameters();
    source.said = (text) => this.say(text);
    source.gone = (why) => showMessage(why, false);
  }

  say(text: string): void {
    element('live-said').textContent = text;
  }

  // The chosen world, or all.
  reset(): void {
    if (!this.source.run.can.resets) return;
    const world = this.chosenWorld();
    this.source.link.send(world === null ? { do: 'reset' } : { do: 'reset', world });
  }

  private later(name: string, message: object): void {
    this.source.link.later(name, message);
    this.app.redraw();
  }

  private chosenWorld(): number | null {
    const { cell } = this.app.chosen;
    if (cell < 0) return null;
    const one = this.app.worlds.layout.cells[cell];
    return this.app.worlds.kindOf(one).first_world + one.world;
  }

  private setUpWorlds(): void {
    const { most_worlds: most, all_worlds: all, kinds } = this.source.run;
    const now = kinds.reduce((sum, kind) => sum + kind.worlds, 0);
    const select = element<HTMLSelectElement>('live-worlds');
    for (const count of [...new Set([...COUNTS.filter((n) => n < most), most, now])].sort((a, b) => a - b)) {
      select.add(new Option(`${count} of ${all.toLocaleString('en')}`, String(count), false, count === now));
    }
    (select.parentElement as HTMLElement).hidden = most === 1;
    select.onchange = () => {
      window.location.hash = `worlds=${select.value}`;
      window.location.reload();
    };
  }

  private setUpParameters(): void {
    const { can, kinds } = this.source.run;
    const box = element('live-parameters');
    if (can.gravity !== null) {
      const { low, high } = can.gravity;
      const g = new THREE.Vector3(...kinds[0].gravity);
      const size = g.length();
      const along = size > 0 ? g.clone().normalize() : new THREE.Vector3(0, this.app.worlds.planar ? -1 : 0, this.app.worlds.planar ? 0 : -1);
      // As far as every component stays within its range.
      let [least, most] = [-Infinity, Infinity];
      along.toArray().forEach((d, c) => {
        if (Math.abs(d) < 1e-9) return;
        const ends = [low[c] / d, high[c] / d];
        least = Math.max(least, Math.min(...ends));
        most = Math.min(most, Math.max(...ends));
      });
      box.append(slider('gravity', least, most, size, 'm/s²', (value) => {
        this.later('gravity', { do: 'gravity', value: along.clone().multiplyScalar(value).toArray() });
      }));
    }
    if (can.friction !== null) {
      const { low, high } = can.friction;
      box.append(slider('friction', low, high, 1, '×', (value) => {
        this.later('friction', { do: 'friction', factor: value });
      }));
    }
  }

  // Once per frame: sliders of the controls of what is chosen, the speed, which worlds are seen.
  update(): void {
    const { cells } = this.app.worlds.layout;
    const cell = this.app.chosen.cell;
    const kind = this.app.worlds.kindOf(cells[Math.max(cell, 0)]);
    const world = this.chosenWorld();
    const controls = kind.controls ?? [];
    // Those of one kind go for all worlds only where all are of that kind.
    const shown = cell >= 0 || this.source.run.kinds.length === 1 ? controls : [];
    const whose = shown.length === 0 ? '-' : `${world ?? 'all'}`;
    if (whose !== this.sliders) {
      this.sliders = whose;
      const values = shown.map((one) => one.value);
      element('live-controls').replaceChildren(...shown.map((one, i) =>
        slider(one.name || `control ${i}`, one.low, one.high, one.value, '', (value) => {
          values[i] = value;
          this.later('controls', { do: 'controls', values: [...values], ...(world === null ? {} : { world }) });
        })));
      element('live-controls-head').hidden = shown.length === 0;
      element('live-controls-head').textContent = world === null ? 'Controls of all worlds' : `Controls of world ${world}`;
    }
    const seen = new Set(this.app.worlds.seen.map((n) => {
      const one = cells[n];
      return this.app.worlds.kindOf(one).first_world + one.world;
    }));
    if (world !== null) seen.add(world);
    this.source.show([...seen].sort((a, b) => a - b), seen.size > 256 ? 30 : 60);
    this.source.link.flush();
  }
}

function slider(name: string, low: number, high: number, value: number, unit: string, changed: (value: number) => void): HTMLElement {
  const row = document.createElement('label');
  row.className = 'row slider';
  const input = document.createElement('input');
  input.type = 'range';
  input.min = String(low);
  input.max = String(high);
  input.step = 'any';
  input.value = String(value);
  input.setAttribute('aria-label', name);
  const output = document.createElement('output');
  const tell = () => {
    output.textContent = `${Number(input.value).toPrecision(3)} ${unit}`;
  };
  input.oninput = () => {
    tell();
    changed(Number(input.value));
  };
  tell();
  const text = document.createElement('span');
  text.textContent = name;
  text.title = name;
  row.append(text, input, output);
  return row;
}
