// Stiff and extreme cases against criteria, in several settings.
import * as Plot from '@observablehq/plot';
import type { Report, Verdict } from './data';
import { distinct, grouped, make, table, type Cell } from './dom';
import { failuresButton, frame, section, totals } from './frame';
import { counted, powerOfTen, short } from './numbers';
import { figure, logScale, plot } from './plots';

const ROW = 19;
const EDGE = 1e4; // ratios beyond are drawn here

const groupOf = (v: Verdict): string => v.group ?? 'cases';
const unitOf = (v: Verdict): string => (v.unit === '' ? '' : ` ${v.unit}`);

const valueText = (v: Verdict): string =>
  (v.value === null ? 'not finite' : short(v.value, 2)) + (v.lost_worlds > 0 ? `, ${v.lost_worlds} lost` : '');
const verdictText = (v: Verdict): string => `${v.passed ? 'PASS' : 'FAIL'} ${valueText(v)}`;

// By the limit, drawn at the edge where that is 0 or the value is none.
function ratioOf(v: Verdict): number {
  if (v.value === null || v.lost_worlds > 0) return EDGE;
  const ratio = v.limit > 0 ? v.value / v.limit : v.value > 0 ? EDGE : 1 / EDGE;
  return Math.min(EDGE, Math.max(1 / EDGE, ratio));
}

// How far each case is from its limit: the setting that is chosen large, the others behind it.
function margins(group: string, verdicts: Verdict[], chosen: () => string): ReturnType<typeof figure> {
  const cases = grouped(verdicts, (v) => v.id);
  const height = 62 + ROW * cases.size;
  const titles = new Map([...cases].map(([id, [first]]) => [id, first.title]));
  return figure(`Values relative to limits, ${group}`, height, (width) => {
    const own = verdicts.filter((v) => v.setting === chosen());
    const others = verdicts.filter((v) => v.setting !== chosen());
    const color = (v: Verdict): string => (v.passed ? 'var(--good)' : 'var(--bad)');
    const place = { x: ratioOf, y: 'id' };
    const room = width < 560 ? 96 : 290;
    const name = (id: string): string => {
      const text = width < 560 ? id : `${id}  ${titles.get(id)}`;
      const most = width < 560 ? 14 : 44;
      return text.length > most ? `${text.slice(0, most - 1)}…` : text;
    };
    const scale = logScale([1 / EDGE, EDGE], { label: 'value / limit', format: powerOfTen, room: width - room, each: 44 });
    return plot(width, height, {
      marginLeft: room, marginRight: 18, marginTop: 34, marginBottom: 26,
      x: { ...scale, domain: [0.5 / EDGE, 2 * EDGE], axis: 'top' },
      y: { type: 'band', domain: [...cases.keys()], label: null, tickFormat: name, tickSize: 0 },
      marks: [
        Plot.ruleX([1], { stroke: 'var(--bad)', strokeDasharray: '2 3' }),
        Plot.dot(others, { ...place, r: 2.5, fill: color, fillOpacity: 0.45 }),
        Plot.dot(own, { ...place, r: 4.5, fill: color, symbol: (v: Verdict) => (v.passed ? 'circle' : 'times'), stroke: color, strokeWidth: 1.5 }),
      ],
    }, {
      data: [...others, ...own], place, fields: [
        ['case', (v) => `${v.id} ${v.title}`],
        ['setting', (v) => v.setting],
        ['verdict', (v) => verdictText(v) + unitOf(v)],
        ['limit', (v) => `${short(v.limit)}${unitOf(v)}`],
        ['of', (v) => v.criterion],
      ],
    });
  });
}

function settingsFigure(verdicts: Verdict[], settings: string[]): HTMLElement {
  const parts = settings.flatMap((setting) => [true, false].map((passed) => ({
    setting, passed, count: verdicts.filter((v) => v.setting === setting && v.passed === passed).length,
  })));
  const height = 40 + 24 * settings.length;
  return figure('Cases by setting', height, (width) => {
    const room = Math.min(240, width * 0.5);
    const most = Math.floor(room / 6.4);
    return plot(width, height, {
      marginLeft: room, marginRight: 14, marginTop: 4, marginBottom: 36,
      x: { label: 'cases', grid: true, ticks: Math.max(2, Math.floor((width - room) / 70)) },
      y: { type: 'band', domain: settings, label: null, tickSize: 0, padding: 0.18, tickFormat: (s: string) => (s.length > most ? `${s.slice(0, most - 1)}…` : s) },
      marks: [
        Plot.barX(parts, { x: 'count', y: 'setting', fill: (p: (typeof parts)[0]) => (p.passed ? 'var(--good)' : 'var(--bad)') }),
      ],
    }, {
      data: parts.filter((p) => p.passed), place: { x: 'count', y: 'setting' }, nearest: Plot.pointerY, fields: [
        ['setting', (p) => p.setting],
        ['PASS', (p) => String(p.count)],
        ['FAIL', (p) => String(verdicts.filter((v) => v.setting === p.setting && !v.passed).length)],
      ],
    });
  }).element;
}

function matrix(verdicts: Verdict[], settings: string[]): HTMLElement {
  const rows = [...grouped(verdicts, (v) => v.id).values()].map((all) => {
    const [first] = all;
    const limit = `${first.criterion}: at most ${short(first.limit)}${unitOf(first)}`;
    const note = first.note ? `${limit}. Note: ${first.note}.` : limit;
    return [{ text: `${first.id} ${first.title}`, note }, ...settings.map((setting): Cell => {
      const v = all.find((one) => one.setting === setting);
      if (!v) return { text: '' };
      return { text: v.passed ? valueText(v) : verdictText(v), mark: v.passed, title: `${verdictText(v)}: ${setting}` };
    })];
  });
  return table(['case', ...settings], rows, 'filtered matrix');
}

// The first of them; all are in the tables.
function listed(names: string[], most = 12): string {
  const more = names.length - most;
  return names.slice(0, more > 1 ? most : names.length).join(', ') + (more > 1 ? ` and ${more} more` : '');
}

export function stabilityPage(report: Report<Verdict[]>): void {
  const verdicts = report.results;
  const settings = distinct(verdicts.map((v) => v.setting));
  const cases = distinct(verdicts.map((v) => v.id));
  frame(report, 'Stiff and extreme cases', [make('p', {},
    'Each case runs in many worlds, with small variations if the case allows them. The value is the maximum over the worlds. A lost world fails ' +
    'its case.')]);
  const failedIn = (setting: string): Verdict[] => verdicts.filter((v) => v.setting === setting && !v.passed);
  const failed = verdicts.filter((v) => !v.passed).length;
  const [usual] = settings;
  totals([
    ...(usual ? [
      { count: `${cases.length - failedIn(usual).length}`, label: `PASS ${usual}`, mark: true },
      { count: `${failedIn(usual).length}`, label: `FAIL ${usual}`, mark: failedIn(usual).length === 0 },
    ] : []),
    { count: `${verdicts.length - failed}`, label: `PASS in ${counted(settings.length, 'setting')}`, mark: true },
    { count: `${failed}`, label: `FAIL in ${counted(settings.length, 'setting')}`, mark: failed === 0 },
  ]);
  section('By setting', [settingsFigure(verdicts, settings), table(['setting', 'PASS', 'FAIL', 'failed cases'], settings.map((setting) => {
    const fails = failedIn(setting);
    return [setting, { text: String(cases.length - fails.length), mark: true }, { text: String(fails.length), ...(fails.length > 0 ? { mark: false } : {}) },
      { text: listed(fails.map((v) => v.id)), left: true }];
  }))]);
  const choice = make('select', { id: 'setting' }, settings.map((s) => make('option', {}, s)));
  const groups = grouped(verdicts, groupOf);
  section('Cases', [make('div', { class: 'row' }, failuresButton(failed), make('label', {}, 'Highlighted setting: ', choice)), make('p', { class: 'quiet' },
    `A dot left of the line at 1 passes. Values above ${powerOfTen(EDGE)} times the limit, lost worlds and non-finite values are drawn at the right edge.`)]);
  const figures = [...groups].map(([group, all]) => {
    const chart = margins(group, all, () => choice.value);
    const own = [...grouped(all, (v) => v.id).values()].map((vs) => vs.some((v) => !v.passed && v.setting === usual));
    const tally = { passed: own.filter((bad) => !bad).length, failed: own.filter((bad) => bad).length };
    section(group[0].toUpperCase() + group.slice(1), [chart.element, matrix(all, settings)], { level: 3, tally });
    return chart;
  });
  choice.onchange = () => { for (const chart of figures) chart.redraw(); };
}
