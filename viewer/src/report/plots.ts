// Figures: Observable Plot's, as wide as there is room, drawn when they come near the window.
import * as Plot from '@observablehq/plot';
import { make } from './dom';

// Of series, told apart also by those who see few colours; report.css has them for light and dark.
const COLORS = 10;
export const colorOf = (index: number): string => `var(--c${index % COLORS})`;

export interface Figure {
  element: HTMLElement;
  redraw(): void;
}

const shown = new WeakMap<Element, (width: number) => void>();
const widths = new ResizeObserver((entries) => {
  for (const { target, contentRect } of entries) shown.get(target)?.(contentRect.width);
});
const near = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (!isIntersecting) continue;
    near.unobserve(target);
    widths.observe(target);
  }
}, { rootMargin: '800px' });
const waiting = new Set<() => void>();
window.addEventListener('beforeprint', () => { for (const draw of waiting) draw(); });

// `draw` gets the width, px. Its height is reserved until then, so that links lead where they should.
export function figure(label: string, height: number, draw: (width: number) => Element): Figure {
  const box = make('div', { class: 'plot', style: `min-height: ${height}px` });
  const element = make('figure', { 'aria-label': label }, box);
  let drawn = 0;
  const at = (width: number): void => {
    if (width < 1) return; // hidden
    drawn = width;
    waiting.delete(first);
    box.replaceChildren(draw(width));
  };
  const first = (): void => at(box.getBoundingClientRect().width);
  waiting.add(first);
  shown.set(box, (width) => { if (Math.abs(width - drawn) >= 1) at(width); });
  near.observe(box);
  return { element, redraw: () => { if (drawn > 0) at(drawn); } };
}

export interface Axis {
  label: string;
  format: (value: number) => string;
  room: number; // px along it
  each: number; // px that a tick takes
}

// Powers of ten, or 1, 2 and 5 times them where few are within.
function ticksOf(low: number, high: number, most: number): number[] {
  const first = Math.floor(Math.log10(low)), last = Math.ceil(Math.log10(high));
  const within = (steps: number[]): number[] => {
    const out = [];
    for (let e = first; e <= last; ++e) for (const m of steps) out.push(Number(`${m}e${e}`));
    return out.filter((x) => x >= low && x <= high);
  };
  const decades = within([1]);
  if (decades.length < 3) {
    for (const finer of [within([1, 2, 5]), within([1, 3])]) {
      if (finer.length >= 2 && finer.length <= most) return finer;
    }
  }
  const stride = Math.ceil(decades.length / Math.max(2, most));
  const skip = decades.findIndex((x) => Math.round(Math.log10(x)) % stride === 0);
  return decades.filter((_, i) => (i - skip) % stride === 0);
}

// A logarithmic scale around all of `values` that are positive.
export function logScale(values: number[], { label, format, room, each }: Axis): Plot.ScaleOptions {
  const drawable = values.filter((x) => Number.isFinite(x) && x > 0);
  let low = Math.min(...drawable), high = Math.max(...drawable);
  if (drawable.length === 0) [low, high] = [0.1, 10];
  const margin = Math.max(1.1, (high / low) ** 0.05);
  low /= margin, high *= margin;
  if (high / low < 4) low /= 1.6, high *= 1.6;
  const ticks = ticksOf(low, high, Math.floor(room / each));
  return { type: 'log', domain: [low, high], ticks, tickFormat: (x: number) => format(x), label };
}

// What is told of a mark: names and values.
export type Field<T> = [string, (item: T) => string];

const told = make('div', { id: 'told', role: 'tooltip' });
told.hidden = true;
document.body.append(told);
window.addEventListener('scroll', () => { told.hidden = true; }, { passive: true });

// Beside a point of the window, and within it.
function tellAt(x: number, y: number): void {
  const { width, height } = told.getBoundingClientRect();
  const left = x + 14 + width <= innerWidth - 6 ? x + 14 : x - 14 - width;
  const top = y + 14 + height <= innerHeight - 6 ? y + 14 : y - 14 - height;
  told.style.left = `${Math.max(6, Math.min(left, innerWidth - 6 - width))}px`;
  told.style.top = `${Math.max(6, top)}px`;
}

// Axes whose ticks are given. As options of a scale, Plot leaves out the labels of some of a logarithmic one.
function axes({ x, y }: Plot.PlotOptions): Plot.Markish[] {
  const out: Plot.Markish[] = [];
  for (const [name, scale] of [['x', x], ['y', y]] as const) {
    if (scale?.type !== 'log') continue;
    const ticks = [...(scale.ticks as number[])];
    const options = { text: scale.tickFormat as (value: number) => string, label: scale.label };
    out.push(name === 'x' ? Plot.gridX(ticks) : Plot.gridY(ticks));
    out.push(name === 'x' ? Plot.axisX(ticks, { ...options, anchor: scale.axis === 'top' ? 'top' : 'bottom' }) : Plot.axisY(ticks, options));
  }
  return out;
}

export interface Pointed<T> {
  data: T[];
  place: Record<string, unknown>; // channels of where they are drawn
  fields: Field<T>[];
  nearest?: typeof Plot.pointer;
}

// A plot that marks what is nearest to the pointer, and tells of it.
export function plot<T>(width: number, height: number, options: Plot.PlotOptions, { data, place, fields, nearest = Plot.pointer }: Pointed<T>): Element {
  const ring = Plot.dot(data as Plot.Data, nearest({ ...place, r: 7, stroke: 'currentColor', strokeWidth: 1.5, ariaLabel: 'pointed' }));
  const out = Plot.plot({
    width, height, className: 'chart',
    style: { background: 'none', fontSize: '12px', overflow: 'visible' },
    ...options,
    ...(options.x?.type === 'log' ? { x: { ...options.x, axis: null } } : {}),
    ...(options.y?.type === 'log' ? { y: { ...options.y, axis: null } } : {}),
    marks: [axes(options), ...(options.marks ?? []), ring],
  });
  let at: [number, number] = [0, 0];
  const follow = (event: Event): void => {
    if (!(event instanceof PointerEvent)) return;
    at = [event.clientX, event.clientY];
    if (!told.hidden) tellAt(...at);
  };
  out.addEventListener('pointermove', follow, { capture: true });
  out.addEventListener('pointerdown', follow, { capture: true });
  out.addEventListener('input', () => {
    const item = out.value as T | null;
    told.hidden = item === null || item === undefined;
    if (told.hidden) return;
    const lines = fields.map(([label, value]) => [label, value(item as T)]).filter(([, text]) => text !== '');
    told.replaceChildren(...lines.map(([label, text]) => make('div', {}, make('b', {}, `${label} `), text)));
    tellAt(...at);
  });
  return out;
}

// Buttons that hide and show series; a second click within a moment leaves one alone.
export interface Series {
  name: string;
  swatch: HTMLElement;
}

export function swatch(color: string, kind: 'line' | 'dash' | 'cross' | 'box' = 'line'): HTMLElement {
  const out = make('i', { class: `swatch ${kind}` });
  out.style.color = color;
  return out;
}

export function legend(groups: Series[][], changed: (hidden: Set<string>) => void): HTMLElement {
  const hidden = new Set<string>();
  const buttons: HTMLButtonElement[] = [];
  const show = (): void => {
    for (const button of buttons) button.setAttribute('aria-pressed', String(!hidden.has(button.value)));
    changed(hidden);
  };
  return make('div', { class: 'legend', role: 'group', 'aria-label': 'Drawn series' }, groups.map((group) => group.map(({ name, swatch: mark }) => {
    const button = make('button', { 'aria-pressed': 'true', value: name, title: 'Click: hide or show. Double click: show only this.' }, mark, name);
    button.onclick = () => {
      if (!hidden.delete(name)) hidden.add(name);
      show();
    };
    button.ondblclick = () => {
      const others = group.filter((s) => s.name !== name);
      const alone = others.every((s) => hidden.has(s.name));
      hidden.delete(name);
      for (const s of others) alone ? hidden.delete(s.name) : hidden.add(s.name);
      show();
    };
    buttons.push(button);
    return button;
  })));
}
