// World-steps per second over worlds, threads, kernels and bodies.
import * as Plot from '@observablehq/plot';
import type { Report, Throughput, ThroughputRow } from './data';
import { distinct, grouped, make, table, type Cell } from './dom';
import { failuresButton, frame, section, totals, type Tally } from './frame';
import { perSecond, prefixed } from './numbers';
import { peersSection } from './peers';
import { colorOf, figure, legend, logScale, plot, swatch, type Field } from './plots';

const HEIGHT = 340;
const BY_THREADS = 'threads', BY_KERNELS = 'instruction set and precision';

const percent = (share: number): string => `${(100 * share).toFixed(1)} %`;
const familyOf = (r: ThroughputRow): string => r.scene.split(':')[0];

interface Metric {
  name: string;
  of: (r: ThroughputRow) => number;
  text: (value: number) => string;
}
const METRICS: Metric[] = [
  { name: 'world-steps per second', of: (r) => r.world_steps_per_s, text: perSecond },
  { name: 'body-steps per second', of: (r) => r.body_steps_per_s, text: perSecond },
  { name: 'share of the memory\'s bandwidth', of: (r) => r.bandwidth_share, text: percent },
  { name: 'bytes per world', of: (r) => r.bytes_per_world, text: prefixed },
];

const fields: Field<ThroughputRow>[] = [
  ['scene', (r) => r.scene], ['', (r) => r.value], ['world-steps', (r) => perSecond(r.world_steps_per_s)],
  ['body-steps', (r) => perSecond(r.body_steps_per_s)], ['of memory', (r) => percent(r.bandwidth_share)],
];

// Rows whose worlds must end with the same bits: those that differ in threads or instruction set alone.
function sameWorlds(rows: ThroughputRow[]): Map<string, ThroughputRow[]> {
  const judged = rows.filter((r) => r.sweep === BY_THREADS || r.sweep === BY_KERNELS);
  return grouped(judged, (r) => [r.sweep, r.scene, r.worlds, r.sweep === BY_KERNELS ? r.value.split(' ').pop() : ''].join('|'));
}

function curves(sweep: string, rows: ThroughputRow[], metric: () => Metric, scenes: string[]): ReturnType<typeof figure> & { legend: HTMLElement } {
  const numeric = rows.every((r) => /^\d+$/.test(r.value));
  const values = distinct(rows.map((r) => r.value)), own = distinct(rows.map(familyOf));
  const color = (r: ThroughputRow): string => colorOf(scenes.indexOf(familyOf(r)));
  let hidden = new Set<string>();
  const names = fields.map(([label, value]): Field<ThroughputRow> => [label || sweep, value]);
  const chart = figure(`Speed by ${sweep}`, HEIGHT, (width) => {
    const { of, text, name } = metric();
    const seen = rows.filter((r) => !hidden.has(familyOf(r)));
    const place = { x: (r: ThroughputRow) => (numeric ? Number(r.value) : r.value), y: of };
    const x = numeric
      ? logScale(values.map(Number), { label: sweep, format: (v) => (v >= 1e4 ? prefixed(v) : String(v)), room: width, each: 52 })
      : { type: 'point' as const, domain: values, label: null, grid: true, padding: 0.3, tickRotate: values.length * 78 > width ? -35 : 0 };
    return plot(width, HEIGHT, {
      marginLeft: 62, marginRight: 20, marginTop: 26, marginBottom: numeric || values.length * 78 <= width ? 42 : 66,
      x: numeric && values.length < (width < 500 ? 5 : 9) ? { ...x, ticks: values.map(Number) } : x,
      y: logScale(rows.map(of), { label: name, format: text, room: HEIGHT, each: 34 }),
      marks: [
        Plot.line(seen, { ...place, z: familyOf, stroke: color, ...(numeric ? {} : { strokeOpacity: 0.35 }) }),
        Plot.dot(seen, { ...place, fill: color, r: 4 }),
      ],
    }, { data: seen, place, fields: names });
  });
  const buttons = legend([own.map((name) => ({ name, swatch: swatch(colorOf(scenes.indexOf(name))) }))], (now) => {
    hidden = now;
    chart.redraw();
  });
  return { ...chart, legend: own.length > 1 ? buttons : make('div') };
}

// Where the time of a step goes.
function stages(rows: ThroughputRow[]): HTMLElement[] {
  const order = new Map<string, number>();
  for (const r of rows) for (const [stage, share] of Object.entries(r.stage_split)) order.set(stage, (order.get(stage) ?? 0) + share);
  const common = [...order].sort((a, b) => b[1] - a[1]).slice(0, 9).map(([stage]) => stage);
  const parts = rows.flatMap((r) => {
    const listed = common.map((stage) => ({ scene: r.scene, stage, share: r.stage_split[stage] ?? 0 }));
    const rest = Object.entries(r.stage_split).reduce((sum, [stage, share]) => sum + (common.includes(stage) ? 0 : share), 0);
    return rest > 0 ? [...listed, { scene: r.scene, stage: 'others', share: rest }] : listed;
  });
  const names = distinct(parts.map((p) => p.stage));
  const color = (stage: string): string => colorOf(names.indexOf(stage));
  const height = 56 + 34 * rows.length;
  const chart = figure('Time by stage', height, (width) => plot(width, height, {
    marginLeft: 96, marginRight: 16, marginTop: 4, marginBottom: 40,
    x: { label: 'share of the time', tickFormat: (x: number) => `${Math.round(100 * x)} %`, domain: [0, 1], grid: true, ticks: width < 500 ? 4 : 10 },
    y: { type: 'band', domain: rows.map((r) => r.scene), label: null, tickSize: 0, padding: 0.2 },
    marks: [
      Plot.barX(parts, { x: 'share', y: 'scene', fill: (p: (typeof parts)[0]) => color(p.stage), insetRight: 1, order: names }),
    ],
  }, {
    data: parts, place: Plot.stackX({ x: 'share', y: 'scene', order: names, z: 'stage' }) as Record<string, unknown>, fields: [
      ['scene', (p) => p.scene], ['stage', (p) => p.stage], ['share', (p) => percent(p.share)]],
  }));
  const keys = make('div', { class: 'legend' }, names.map((name) => make('span', { class: 'key' }, swatch(color(name), 'box'), name)));
  return [chart.element, keys];
}

// What was varied has a column of its own where no other column is just that. `wrong`: those whose hash is, where it is judged.
function rowsTable(sweep: string, rows: ThroughputRow[], wrong: Set<ThroughputRow> | null): HTMLElement {
  const extra = sweep !== 'worlds' && sweep !== BY_THREADS;
  return table(['scene', ...(extra ? [sweep] : []), 'worlds', 'threads', 'world-steps', 'body-steps', 'bytes per world', 'of memory', 'hash'],
    rows.map((r): (string | Cell)[] => [
      r.scene, ...(extra ? [r.value] : []), String(r.worlds), String(r.threads), perSecond(r.world_steps_per_s), perSecond(r.body_steps_per_s),
      String(r.bytes_per_world), percent(r.bandwidth_share), { text: r.hash, ...(wrong ? { mark: !wrong.has(r) } : {}) }]), 'filtered');
}

export function throughputPage(report: Report<Throughput>): void {
  const { gflops, gigabytes_per_s, rows, peers, peer_failures: failures } = report.results;
  frame(report, 'Throughput', [make('p', {},
    `One thread of this machine multiplies and adds at ${gflops.toFixed(0)} GFLOP/s (float32) and copies memory at ${gigabytes_per_s.toFixed(0)} GB/s, read and ` +
    'written. “Of memory” is the share of this bandwidth for one read and one write of the state per step; above 100 % the state is in a cache. ' +
    'Each row is the fastest of at least three runs of the same steps, after 60 warm-up steps. The hash is that after these steps. A scene passes if its ' +
    'hash is equal with any number of threads and, in each precision, on every instruction set.')]);
  const groups = [...sameWorlds(rows).values()];
  const isSame = (all: ThroughputRow[]): boolean => new Set(all.map((r) => r.hash)).size === 1;
  const wrong = new Set(groups.filter((all) => !isSame(all)).flat());
  const same = groups.filter(isSame).length, broken = failures?.length ?? 0;
  const best = rows.reduce((a, b) => (b.body_steps_per_s > (a?.body_steps_per_s ?? 0) ? b : a), rows[0]);
  totals([
    { count: String(same), label: 'PASS: same bits', mark: true },
    { count: String(groups.length - same), label: 'FAIL: different bits', mark: groups.length === same },
    ...(peers ? [{ count: String(broken), label: 'FAIL: other engines', mark: broken === 0 }] : []),
    ...(best ? [{ count: perSecond(best.body_steps_per_s), label: `maximum body-steps (${best.scene})` }] : []),
  ]);
  const choice = make('select', { id: 'metric' }, METRICS.map(({ name }) => make('option', {}, name)));
  const metric = (): Metric => METRICS[Math.max(0, choice.selectedIndex)];
  const scenes = distinct(rows.map(familyOf));
  if (rows.length > 0) section('Sweeps', [make('div', { class: 'row' }, failuresButton(groups.length - same + broken), make('label', {}, 'Plots show ', choice))]);
  const charts = [...grouped(rows, (r) => r.sweep)].map(([sweep, all]) => {
    const own = groups.filter((g) => g[0].sweep === sweep), bad = own.filter((g) => !isSame(g)).length;
    const judged: { tally?: Tally } = own.length > 0 ? { tally: { passed: own.length - bad, failed: bad } } : {};
    const chart = curves(sweep, all, metric, scenes);
    const split = all.filter((r) => Object.keys(r.stage_split).length > 0);
    section(`By ${sweep}`, [chart.element, chart.legend,
      rowsTable(sweep, all, own.length > 0 ? wrong : null),
      split.length > 0 ? [make('h3', {}, `Time by stage, ${split[0].worlds} worlds`), stages(split)] : null,
    ], judged);
    return chart;
  });
  choice.onchange = () => { for (const chart of charts) chart.redraw(); };
  if (peers) peersSection(report.results, peers);
}
