// Error against run time of cases whose solution is known.
import * as Plot from '@observablehq/plot';
import type { AccuracyCase, AccuracyPoint, Precision, Published, Report } from './data';
import { distinct, grouped, make, table, type Cell } from './dom';
import { failuresButton, frame, section, totals } from './frame';
import { counted, duration, powerOfTen, raised, short } from './numbers';
import { colorOf, figure, legend, logScale, plot, swatch } from './plots';

const PRECISIONS: Record<Precision, string> = { f64: 'float64', f32: 'float32' };
const HEIGHT = 400;

const secondsOf = (p: AccuracyPoint): number => 1e-6 * p.us_per_world;
const stepOf = (p: { step_s: number }): string => duration(p.step_s);
const cheapest = (c: AccuracyCase): AccuracyPoint[] =>
  [...c.cheapest_at_level].sort((a, b) => a.us_per_world - b.us_per_world);

interface Drawn {
  x: number; // s
  y: number;
  name: string;
  precision: Precision | null; // null: published
  step: string;
}

const drawnPoint = (p: AccuracyPoint): Drawn =>
  ({ x: secondsOf(p), y: p.error ?? NaN, name: p.method, precision: p.precision, step: stepOf(p) });
const drawnPublished = (p: Published): Drawn =>
  ({ x: p.seconds ?? NaN, y: p.error ?? NaN, name: p.engine, precision: null, step: stepOf(p) });

const canDraw = ({ x, y }: Drawn): boolean => Number.isFinite(x) && x > 0 && Number.isFinite(y) && y > 0;

function picture(c: AccuracyCase): HTMLElement[] {
  const own = c.points.map(drawnPoint);
  const all = [...own, ...c.published.filter((p) => p.seconds !== null).map(drawnPublished)];
  const points = all.filter(canDraw);
  const methods = distinct(own.map((p) => p.name)), engines = distinct(all.filter((p) => p.precision === null).map((p) => p.name));
  const names = [...methods, ...engines];
  const color = (name: string): string => colorOf(names.indexOf(name));
  const place = { x: 'x', y: 'y' };
  let hidden = new Set<string>();
  const draw = (width: number): Element => {
    const seen = points.filter((p) => !hidden.has(p.name) && !(p.precision && hidden.has(PRECISIONS[p.precision])));
    const of = (precision: Precision | null): Drawn[] => seen.filter((p) => p.precision === precision);
    const lines = { ...place, z: 'name', stroke: (p: Drawn) => color(p.name), strokeWidth: 1.6 };
    return plot(width, HEIGHT, {
      marginLeft: 52, marginRight: 16, marginBottom: 42, marginTop: 26,
      x: logScale(points.map((p) => p.x), { label: 'run time per world', format: duration, room: width - 70, each: 64 }),
      y: logScale([...points.map((p) => p.y), c.level], { label: `error, ${c.unit}`, format: powerOfTen, room: HEIGHT, each: 36 }),
      marks: [
        Plot.ruleY([c.level], { stroke: 'var(--bad)', strokeDasharray: '2 3' }),
        Plot.text([c.level], { y: (x: number) => x, frameAnchor: 'right', dy: -7, text: () => 'required', fill: 'var(--bad)' }),
        Plot.line(of('f32'), { ...lines, strokeDasharray: '5 3' }),
        Plot.line(of('f64'), lines),
        Plot.dot(of('f32'), { ...place, r: 3, stroke: (p: Drawn) => color(p.name), fill: 'var(--paper)' }),
        Plot.dot(of('f64'), { ...place, r: 3, fill: (p: Drawn) => color(p.name) }),
        Plot.dot(of(null), { ...place, r: 5, symbol: 'times', strokeWidth: 2, stroke: (p: Drawn) => color(p.name) }),
      ],
    }, {
      data: seen, place, fields: [
        ['method', (p) => `${p.name}, ${p.precision ?? 'published'}`],
        ['step', (p) => p.step],
        ['error', (p) => `${short(p.y)} ${c.unit}`],
        ['run time', (p) => duration(p.x)],
      ],
    });
  };
  const chart = figure(`${c.id}: error against run time`, HEIGHT, draw);
  const precisions = (['f64', 'f32'] as const).filter((p) => own.some((o) => o.precision === p));
  const buttons = legend([
    methods.map((name) => ({ name, swatch: swatch(color(name)) })),
    engines.map((name) => ({ name, swatch: swatch(color(name), 'cross') })),
    precisions.map((p) => ({ name: PRECISIONS[p], swatch: swatch('currentColor', p === 'f32' ? 'dash' : 'line') })),
  ], (now) => {
    hidden = now;
    chart.redraw();
  });
  const exact = own.filter((p) => p.y === 0).length, lost = own.filter((p) => Number.isNaN(p.y)).length;
  const left = [exact > 0 ? `${counted(exact, 'point')} with error 0` : '', lost > 0 ? `${counted(lost, 'point')} of lost worlds` : '']
    .filter((text) => text !== '');
  return [chart.element, buttons, ...(left.length ? [make('p', { class: 'quiet' }, `Not drawn: ${left.join(', ')}.`)] : [])];
}

function levelTable(c: AccuracyCase): HTMLElement {
  const reached = cheapest(c);
  if (reached.length === 0) return make('p', { class: 'fail' }, `No method reaches ${short(c.level)} ${c.unit} here.`);
  return table([`cheapest to ${short(c.level)} ${c.unit}`, 'step', 'error', 'run time per world'],
    reached.map((p) => [`${p.method}, ${p.precision}`, stepOf(p), short(p.error ?? NaN, 2), duration(secondsOf(p))]));
}

// Methods down, steps across.
function allPoints(c: AccuracyCase): HTMLElement {
  const steps = distinct(c.points.map((p) => p.step_s)).sort((a, b) => b - a);
  const rows = [...grouped(c.points, (p) => `${p.method}, ${p.precision}`)].map(([name, points]) => [name, ...steps.map((step): Cell => {
    const p = points.find((q) => q.step_s === step);
    if (!p) return { text: '' };
    if (p.error === null) return { text: 'lost', mark: false, note: duration(secondsOf(p)) };
    return { text: short(p.error, 2), note: duration(secondsOf(p)), ...(p.error <= c.level ? { mark: true } : {}) };
  })]);
  return make('details', {}, make('summary', {}, `All ${counted(c.points.length, 'point')}`),
    table(['error, run time', ...steps.map((s) => duration(s))], rows));
}

function published(c: AccuracyCase): HTMLElement | null {
  if (c.published.length === 0) return null;
  return table(['published', 'step', 'error', 'wall time'], c.published.map((p) => [
    p.engine, stepOf(p), p.error === null ? '' : short(p.error), p.seconds === null ? '' : duration(p.seconds)]));
}

export function accuracyPage(report: Report<AccuracyCase[]>): void {
  const cases = report.results.map((c) => ({ ...c, metric: raised(c.metric), unit: raised(c.unit) }));
  frame(report, 'Error against run time', [make('p', {},
    'One thread, one group of lanes, fastest of up to five runs. The run time is that of the whole simulation divided by the number of worlds. ' +
    'Lines are float64, dashes float32. Crosses are published values, measured on other machines. A case passes if a method reaches the ' +
    'required error.')]);
  const failed = cases.filter((c) => c.cheapest_at_level.length === 0);
  const points = cases.flatMap((c) => c.points), lost = points.filter((p) => p.error === null).length;
  totals([
    { count: String(cases.length - failed.length), label: 'PASS: error reached', mark: true },
    { count: String(failed.length), label: 'FAIL: not reached', mark: failed.length === 0 },
    { count: String(points.length), label: 'points' },
    { count: String(lost), label: 'points of lost worlds' },
  ]);
  section('Summary', [failuresButton(failed.length), table(['case', 'required error', '', 'cheapest method', 'step', 'run time per world'],
    cases.map((c) => {
      const [best] = cheapest(c);
      const mark: Cell = { text: best ? 'PASS' : 'FAIL', mark: best !== undefined };
      return [{ text: `${c.id} ${c.title}` }, `${short(c.level)} ${c.unit}`, mark, { text: best ? `${best.method}, ${best.precision}` : 'none', left: true },
        best ? stepOf(best) : '', best ? duration(secondsOf(best)) : ''];
    }), 'filtered')]);
  for (const c of cases) {
    const passed = c.cheapest_at_level.length > 0;
    section(`${c.id} ${c.title}`, [
      make('p', {}, `Error: ${c.metric} (${c.unit}), after ${short(c.simulated_s)} s.`),
      picture(c), levelTable(c), published(c), allPoints(c),
    ], { name: c.id, tally: { passed: Number(passed), failed: Number(!passed) } });
  }
}
