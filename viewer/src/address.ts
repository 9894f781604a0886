// What the address of a page asks for: page.html#time=2.5&world=3&follow=torso&color=speed&theme=dark&loop=off.
import type { Kind } from './data';
import { element } from './elements';
import type { App } from './main';

const MOST_NAMES = 12; // of bodies in a complaint

// As 'a, b or c'.
function either(choices: string[]): string {
  return choices.length < 2 ? choices.join() : `${choices.slice(0, -1).join(', ')} or ${choices.at(-1)}`;
}

// The row of a moving body by its name or, where no body is called so, its index in the scene; -1: there is none.
export function rowOf(kind: Kind, wanted: string): number {
  const named = kind.bodies.find((body) => body.row !== null && body.name === wanted);
  if (named !== undefined) return named.row as number;
  return (/^\d+$/.test(wanted) ? kind.bodies[Number(wanted)]?.row : null) ?? -1;
}

function movingBodies(kind: Kind): string {
  const names = kind.bodies.flatMap((body, b) => (body.row === null ? [] : [body.name || String(b)]));
  return names.length > MOST_NAMES ? `${names.slice(0, MOST_NAMES).join(', ')}, ...` : either(names);
}

// Does it, but for the time where `timeToo` is false. What could not be done, a line each.
export function obeyAddress(app: App, wanted: URLSearchParams, timeToo = true): string[] {
  const refused: string[] = [];
  const done: Record<string, (value: string) => string> = { // what was expected, or empty
    time: (value) => {
      const time = Number(value);
      if (value.trim() === '' || !Number.isFinite(time) || time < 0) return 'seconds, 0 or later';
      if (timeToo) app.timeline.seek(time);
      return '';
    },
    theme: (value) => {
      if (value !== 'light' && value !== 'dark') return 'light or dark';
      app.setTheme(value);
      return '';
    },
    color: (value) => {
      const choice = element<HTMLSelectElement>('color');
      const colors = [...choice.options].map((option) => option.value);
      if (!colors.includes(value)) return either(colors);
      choice.value = value;
      choice.dispatchEvent(new Event('change'));
      return '';
    },
    world: (value) => {
      const cells = app.worlds.layout.cells.length;
      const cell = Number(value);
      if (!/^\d+$/.test(value) || cell >= cells) return `0 to ${cells - 1}`;
      app.choose(cell, -1);
      app.showCell(cell);
      return '';
    },
    // Of the world that is chosen by now, or of the first.
    follow: (value) => {
      const cell = Math.max(0, app.chosen.cell);
      const kind = app.worlds.kindOf(app.worlds.layout.cells[cell]);
      const row = rowOf(kind, value);
      if (row < 0) return `a moving body: ${movingBodies(kind)}`;
      app.showBody(cell, row);
      return '';
    },
    loop: (value) => {
      if (value !== 'on' && value !== 'off') return 'on or off';
      app.timeline.looping = value === 'on';
      return '';
    },
  };
  if (app.live !== null) {
    delete done.time;
    delete done.loop;
    done.worlds = (value) => (/^\d+$/.test(value) && value !== '0' ? '' : 'a number of worlds'); // obeyed before
  }
  for (const name of wanted.keys()) {
    if (done[name] === undefined && name !== 'film') refused.push(`'${name}' is unknown; expected ${either(Object.keys(done))}`);
  }
  for (const [name, obey] of Object.entries(done)) {
    const value = wanted.get(name);
    const expected = value === null ? '' : obey(value);
    if (expected !== '') refused.push(`${name} is '${value}'; expected ${expected}`);
  }
  return refused;
}
