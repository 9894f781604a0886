// Laws of mechanics over families of random scenes: the share of worlds that break each.
import * as Plot from '@observablehq/plot';
import type { InvariantRow, Report } from './data';
import { distinct, grouped, make, table, type Cell } from './dom';
import { failuresButton, frame, section, totals } from './frame';
import { counted, powerOfTen, raised, short } from './numbers';
import { colorOf, figure, legend, logScale, plot, swatch } from './plots';

const ROW = 19;
const MOST = 0.1; // %, that passes
const EDGE = 0.01; // %, where a share of 0 is drawn

const percentOf = (r: InvariantRow): number => 100 * r.share;
const settingOf = (r: InvariantRow): string => `${r.units}, ${r.precision}`;
const unitOf = (r: InvariantRow): string => (r.unit === '' ? '' : ` ${raised(r.unit)}`);
const worstText = (r: InvariantRow): string => (r.worst === null ? 'not finite' : short(r.worst, 2));
const isBad = (r: InvariantRow): boolean => r.required && !r.passed;
const capitalized = (text: string): string => text[0].toUpperCase() + text.slice(1);
const sum = (values: number[]): number => values.reduce((a, b) => a + b, 0);

function verdictOf(r: InvariantRow): string {
  if (r.passed) return 'PASS';
  return r.required ? 'FAIL' : 'not required';
}

// Families down, shares across, a color for each setting.
function shares(law: string, rows: InvariantRow[], settings: string[]): HTMLElement[] {
  const families = distinct(rows.map((r) => r.family));
  const height = 62 + ROW * families.length;
  const color = (r: InvariantRow): string => colorOf(settings.indexOf(settingOf(r)));
  let hidden = new Set<string>();
  const chart = figure(`Worlds that break the law, ${law}`, height, (width) => {
    const seen = rows.filter((r) => !hidden.has(settingOf(r)));
    const place = { x: (r: InvariantRow) => Math.max(EDGE, percentOf(r)), y: 'family' };
    const room = width < 560 ? 110 : 240;
    const most = Math.floor(room / 6.6);
    const scale = logScale([EDGE, 100], { label: 'worlds that break the law, %', format: powerOfTen, room: width - room, each: 44 });
    return plot(width, height, {
      marginLeft: room, marginRight: 18, marginTop: 34, marginBottom: 26,
      x: { ...scale, domain: [0.7 * EDGE, 140], axis: 'top' },
      y: { type: 'band', domain: families, label: null, tickSize: 0, tickFormat: (f: string) => (f.length > most ? `${f.slice(0, most - 1)}…` : f) },
      marks: [
        Plot.ruleX([MOST], { stroke: 'var(--bad)', strokeDasharray: '2 3' }),
        Plot.dot(seen, { ...place, r: 4.5, stroke: color, strokeWidth: 1.5, fill: (r: InvariantRow) => (r.required ? color(r) : 'var(--paper)'), fillOpacity: 0.7 }),
      ],
    }, {
      data: seen, place, fields: [
        ['family', (r) => r.family],
        ['setting', settingOf],
        ['verdict', verdictOf],
        ['broken', (r) => `${r.broken} of ${counted(r.worlds, 'world')}, ${short(percentOf(r))} %`],
        ['worst', (r) => `${worstText(r)}${r.worst === null ? '' : unitOf(r)}, world ${r.worst_world}`],
        ['limit', (r) => `${short(r.limit)}${unitOf(r)}`],
        ['of', (r) => r.criterion],
      ],
    });
  });
  const buttons = legend([settings.map((name, i) => ({ name, swatch: swatch(colorOf(i)) }))], (now) => {
    hidden = now;
    chart.redraw();
  });
  return [chart.element, buttons];
}

function rowsTable(rows: InvariantRow[]): HTMLElement {
  return table(['family', 'units', 'precision', 'broken', '', 'worst', 'limit', 'silent', 'lost', 'command that records the worst world'],
    rows.map((r, i): (string | Cell)[] => [
      { text: r.family, ...(rows[i - 1]?.family === r.family ? {} : { note: `${r.title}: ${r.criterion}` }) },
      r.units, r.precision,
      { text: `${short(percentOf(r))} %`, note: `${r.broken} of ${r.worlds}` },
      { text: verdictOf(r), ...(r.passed ? { mark: true } : r.required ? { mark: false } : {}) },
      { text: worstText(r), note: `world ${r.worst_world}` },
      `${short(r.limit)}${unitOf(r)}`,
      String(r.silent), String(r.lost),
      { text: r.command, left: true },
    ]), 'filtered');
}

export function invariantsPage(report: Report<InvariantRow[]>): void {
  const rows = report.results;
  const settings = distinct(rows.map(settingOf));
  const laws = grouped(rows, (r) => r.law);
  frame(report, 'Laws of mechanics', [make('p', {},
    'Each family draws random scenes of one type. Every world is checked against a law after every step; the largest deviation counts. With similar ' +
    'units, gravity and time scale with length, from 1 mm to 100 m. With earth units, gravity is 9.81 m/s² and a step is 1/60 s, from 1 cm to 100 m. ' +
    `A family passes if at most ${MOST} % of its worlds break the law. A silent world is beyond ten times the limit, and its status is ok.`),
  make('p', {}, 'A command records a world. manyworlds view shows the recording.')]);
  const required = rows.filter((r) => r.required);
  const failed = required.filter((r) => !r.passed).length;
  const broken = sum(required.map((r) => r.broken)), silent = sum(required.map((r) => r.silent));
  totals([
    { count: String(required.length - failed), label: 'PASS', mark: true },
    { count: String(failed), label: 'FAIL', mark: failed === 0 },
    { count: String(sum(rows.map((r) => r.worlds))), label: 'worlds' },
    { count: String(broken), label: 'worlds that break a required law' },
    { count: String(silent), label: 'of these, silent', mark: silent === 0 },
  ]);
  const head = ['law', ...settings.flatMap((s) => [s, ''])];
  section('Summary', [failuresButton(failed), table(head, [...laws].map(([law, all]) => [capitalized(law), ...settings.flatMap((setting): Cell[] => {
    const own = all.filter((r) => r.required && settingOf(r) === setting);
    if (own.length === 0) return [{ text: '' }, { text: '' }];
    const bad = own.filter(isBad).length;
    const share = sum(own.map((r) => r.broken)) / Math.max(1, sum(own.map((r) => r.worlds)));
    return [
      { text: bad > 0 ? `${bad} FAIL` : 'PASS', mark: bad === 0, note: `of ${own.length}` },
      { text: `${short(100 * share)} %`, note: 'broken' },
    ];
  })]), 'filtered')]);
  section('Laws', [make('p', { class: 'quiet' },
    `Dots left of the line at ${MOST} % pass. Shares below ${EDGE} % are drawn at the left edge. Hollow dots are families that are measured, but not required ` +
    'to pass.')]);
  for (const [law, all] of laws) {
    const judged = all.filter((r) => r.required), bad = judged.filter(isBad).length;
    section(capitalized(law), [shares(law, all, settings), rowsTable(all)],
      { level: 3, tally: { passed: judged.length - bad, failed: bad } });
  }
}
