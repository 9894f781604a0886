// Benefit of omitting unused stages and arrays.
import * as Plot from '@observablehq/plot';
import type { Report, WorthRow } from './data';
import { distinct, grouped, make, table, type Cell } from './dom';
import { failuresButton, frame, section, totals, type Tally } from './frame';
import { counted, perSecond, short } from './numbers';
import { colorOf, figure, legend, logScale, plot, swatch, type Field } from './plots';

const AGAINST = ' against all pairs';
const ROW = 22;

const ratioText = (ratio: number): string => ratio.toFixed(2);
const isWrong = (r: WorthRow): boolean => r.must_be_same && !r.same_bits;
const bitsText = (r: WorthRow): string => (r.same_bits ? 'equal' : r.must_be_same ? 'DIFFERENT' : 'differ');
const colorOfRow = (r: WorthRow): string => (isWrong(r) ? 'var(--bad)' : r.must_be_same ? colorOf(0) : colorOf(7));

const fields: Field<WorthRow>[] = [
  ['scene', (r) => r.scene], ['variant', (r) => r.variant], ['time', (r) => `${ratioText(r.time_ratio)} times the default`],
  ['by default', (r) => `${perSecond(r.world_steps_per_s)} world-steps`], ['bits', bitsText],
  ['maximum in 10 s', (r) => r.holds ?? ''],
];

function fitted(text: string, room: number): string {
  const most = Math.floor(room / 6.4);
  return text.length > most ? `${text.slice(0, most - 1)}…` : text;
}

// A line of each variant from 1 to its ratio.
function bars(rows: WorthRow[], label: string, nameOf = (r: WorthRow): string => r.variant): HTMLElement {
  const height = 54 + ROW * rows.length;
  return figure(label, height, (width) => {
    const room = Math.min(260, width * 0.48);
    const place = { x: 'time_ratio', y: nameOf };
    return plot(width, height, {
      marginLeft: room, marginRight: 22, marginTop: 6, marginBottom: 42,
      x: logScale([1, ...rows.map((r) => r.time_ratio)], { label: 'time / default time', format: short, room: width - room, each: 48 }),
      y: { type: 'band', domain: rows.map(nameOf), label: null, tickSize: 0, tickFormat: (v: string) => fitted(v, room) },
      marks: [
        Plot.ruleX([1], { stroke: 'currentColor' }),
        Plot.ruleY(rows, { x1: 1, x2: 'time_ratio', y: nameOf, stroke: colorOfRow, strokeWidth: 5, strokeOpacity: 0.45 }),
        Plot.dot(rows, { ...place, fill: colorOfRow, r: 5 }),
      ],
    }, { data: rows, place, fields, nearest: Plot.pointerY });
  }).element;
}

// Each variant in all scenes that have it.
function overview(rows: WorthRow[]): HTMLElement {
  const common = [...grouped(rows, (r) => r.variant)].filter(([, all]) => all.length > 1).map(([name]) => name);
  const seen = rows.filter((r) => common.includes(r.variant));
  const height = 54 + ROW * common.length;
  return figure('Variants in all scenes', height, (width) => {
    const room = Math.min(260, width * 0.48);
    return plot(width, height, {
      marginLeft: room, marginRight: 22, marginTop: 6, marginBottom: 42,
      x: logScale([1, ...seen.map((r) => r.time_ratio)], { label: 'time / default time', format: short, room: width - room, each: 48 }),
      y: { type: 'band', domain: common, label: null, grid: true, tickSize: 0, tickFormat: (v: string) => fitted(v, room) },
      marks: [
        Plot.ruleX([1], { stroke: 'currentColor' }),
        Plot.dot(seen, { x: 'time_ratio', y: 'variant', fill: colorOfRow, fillOpacity: 0.7, r: 4.5 }),
      ],
    }, { data: seen, place: { x: 'time_ratio', y: 'variant' }, fields });
  }).element;
}

// Pair searches over the number of bodies, for each family of scenes.
function crossover(rows: WorthRow[]): HTMLElement[] {
  const bodies = (r: WorthRow): number => r.bodies ?? Number(r.scene.split(':')[1]);
  const name = (r: WorthRow): string => `${r.scene.split(':')[0]}, ${r.variant.replace(AGAINST, '')}`;
  const names = distinct(rows.map(name));
  let hidden = new Set<string>();
  const height = 340;
  const chart = figure('Finding pairs', height, (width) => {
    const seen = rows.filter((r) => !hidden.has(name(r)));
    const place = { x: bodies, y: 'time_ratio' };
    const color = (r: WorthRow): string => colorOf(names.indexOf(name(r)));
    return plot(width, height, {
      marginLeft: 48, marginRight: 16, marginTop: 26, marginBottom: 42,
      x: logScale(rows.map(bodies), { label: 'bodies', format: short, room: width, each: 48 }),
      y: logScale([1, ...rows.map((r) => r.time_ratio)], { label: 'time / time with all pairs', format: short, room: height, each: 32 }),
      marks: [
        Plot.ruleY([1], { stroke: 'currentColor' }),
        Plot.line(seen, { ...place, z: name, stroke: color }),
        Plot.dot(seen, { ...place, fill: color, r: 3.5 }),
      ],
    }, { data: seen, place, fields: [['bodies', (r) => String(bodies(r))], ...fields] });
  });
  return [chart.element, legend([names.map((n) => ({ name: n, swatch: swatch(colorOf(names.indexOf(n))) }))], (now) => {
    hidden = now;
    chart.redraw();
  })];
}

function rowsTable(rows: WorthRow[], first: (r: WorthRow) => string, head: string): HTMLElement {
  const holds = rows.some((r) => r.holds);
  return table([head, 'ratio', holds ? 'maximum in 10 s' : 'bits'], rows.map((r): (string | Cell)[] => [
    first(r), ratioText(r.time_ratio),
    r.holds ? { text: r.holds } : { text: bitsText(r), ...(r.must_be_same ? { mark: r.same_bits } : {}) }]), 'filtered');
}

export function planPage(report: Report<WorthRow[]>): void {
  const rows = report.results;
  frame(report, 'Benefit of omitting unused stages', [make('p', {},
    'Each variant and the default batch step alternately on one thread. The ratio is the median of (time of the variant / default time): ' +
    '1.30 means that a step takes 30 % longer. Bits are those of positions and velocities of all worlds after the last step. A variant ' +
    'that must have equal bits passes if they are equal.')]);
  const judged = rows.filter((r) => r.must_be_same), wrong = judged.filter(isWrong);
  totals([
    { count: String(judged.length - wrong.length), label: 'PASS: equal bits', mark: true },
    { count: String(wrong.length), label: 'FAIL: different bits', mark: wrong.length === 0 },
    { count: String(rows.length - judged.length), label: 'may differ in bits' },
    { count: String(distinct(rows.map((r) => r.scene)).length), label: 'scenes' },
  ]);
  const pairs = rows.filter((r) => r.variant.endsWith(AGAINST));
  const scenes = [...grouped(rows.filter((r) => !pairs.includes(r)), (r) => r.scene).values()];
  const held = scenes.filter((all) => all[0].holds), plain = scenes.filter((all) => !all[0].holds && all.some((r) => r.must_be_same));
  const fewer = scenes.filter((all) => !held.includes(all) && !plain.includes(all)).flat();
  const keys = [['must have equal bits', colorOf(0)], ['bits may differ', colorOf(7)], ['must be equal and differs', 'var(--bad)']];
  section('All scenes', [
    failuresButton(wrong.length),
    make('p', { class: 'quiet' }, keys.map(([text, color]) => make('span', { class: 'key' }, swatch(color, 'box'), text))),
    plain.length > 1 ? overview(plain.flat()) : null]);
  const tallyOf = (all: WorthRow[]): { tally?: Tally } => {
    const own = all.filter((r) => r.must_be_same), bad = own.filter(isWrong).length;
    return own.length > 0 ? { tally: { passed: own.length - bad, failed: bad } } : {};
  };
  const scenePart = (all: WorthRow[]): void => {
    const [{ scene, world_steps_per_s: speed, bodies }] = all;
    section(scene, [make('p', {}, `${perSecond(speed)} world-steps by default${bodies ? `, ${counted(bodies, 'body', 'bodies')}` : ''}.`), bars(all, scene),
      rowsTable(all, (r) => r.variant, 'variant')], { ...tallyOf(all), level: 3, label: scene.split(', by ')[0] });
  };
  for (const all of plain) scenePart(all);
  const both = (r: WorthRow): string => `${r.scene}: ${r.variant}`;
  if (fewer.length > 0) {
    section('Cost of accuracy', [
      make('p', {}, 'Scenes with more than four substeps by default, or with trees of joints, simulated with four substeps and sweeps instead.'),
      bars(fewer, 'Four substeps', both), rowsTable(fewer, both, 'scene and variant')]);
  }
  if (held.length > 0) {
    section('Trees of joints compared with sweeps', [make('p', {}, 'Times are relative to sweeps with four substeps.')]);
    for (const all of held) scenePart(all);
  }
  if (pairs.length > 0) {
    section('Break-even of pair searches', [crossover(pairs), rowsTable(pairs, both, 'scene and variant')],
      { ...tallyOf(pairs), label: 'Pair searches' });
  }
}
