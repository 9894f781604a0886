// What all reports have: a title, totals, contents, sections.
import { element } from '../elements';
import type { Report } from './data';
import { add, make, type Child } from './dom';

export interface Total {
  count: string; // "107 of 114"
  label: string;
  mark?: boolean; // whether it is good news
}

// In the contents: how many of it passed and failed.
export interface Tally {
  passed: number;
  failed: number;
}

// What a link may end with, "#By-worlds": the same in every report of a kind.
function anchorOf(label: string): string {
  const name = label.replace(/[^\w.-]+/g, '-');
  let out = name;
  for (let i = 2; document.getElementById(out) !== null; ++i) out = `${name}-${i}`;
  return out;
}

function tallyText({ passed, failed }: Tally): HTMLElement {
  return failed > 0
    ? make('span', { class: 'fail' }, `${failed} FAIL`)
    : make('span', { class: 'pass' }, passed > 0 ? 'PASS' : '');
}

interface Place {
  level?: 2 | 3; // 3 is below the last of level 2
  tally?: Tally;
  label?: string; // in the contents, if not the heading
  name?: string; // in links, if not the label
}

// A part of the page with a line in the contents.
export function section(heading: string, children: Child[], { level = 2, tally, label = heading, name }: Place = {}): HTMLElement {
  const id = anchorOf(name ?? label);
  const link = make('a', { href: `#${id}` }, label);
  element('contents-list').append(make('li', { class: `level${level}` }, link, tally ? tallyText(tally) : null));
  const out = make('section', { id }, make(level === 2 ? 'h2' : 'h3', {}, heading, tally ? tallyText(tally) : null));
  if (tally) out.classList.add('judged');
  add(out, children);
  element('main').append(out);
  return out;
}

export function totals(all: Total[]): void {
  for (const { count, label, mark } of all) {
    const names = ['total', mark === undefined ? '' : mark ? 'pass' : 'fail'].join(' ').trim();
    element('totals').append(make('div', { class: names }, make('b', {}, count), make('span', {}, label)));
  }
}

// Only what failed is shown while it is pressed.
export function failuresButton(failed: number): HTMLElement {
  const button = make('button', { id: 'only-failures', 'aria-pressed': 'false' }, 'Only failures');
  button.disabled = failed === 0;
  button.onclick = () => {
    const on = document.body.classList.toggle('only-failures');
    button.setAttribute('aria-pressed', String(on));
  };
  return button;
}

export function frame(report: Report<unknown>, title: string, text: Child[]): void {
  document.title = `manyworlds: ${title}`;
  element('title').textContent = title;
  const date = report.date ? `, ${report.date.replace('T', ' ').replace('Z', ' UTC')}` : '';
  element('about').textContent = `${report.machine}${date}${report.quick ? '. Short run (--quick).' : ''}`;
  element('main').append(make('div', { class: 'text' }, text));
  const dark = element<HTMLButtonElement>('dark');
  const setDark = (on: boolean): void => {
    document.documentElement.classList.toggle('dark', on);
    dark.setAttribute('aria-pressed', String(on));
  };
  setDark(window.matchMedia('(prefers-color-scheme: dark)').matches);
  dark.onclick = () => setDark(!document.documentElement.classList.contains('dark'));
  const contents = element<HTMLDetailsElement>('contents-box');
  const wide = window.matchMedia('(min-width: 1000px)');
  const fit = (): void => { contents.open = wide.matches; };
  wide.onchange = fit;
  fit();
  element('contents-list').onclick = (event) => {
    if (!wide.matches && event.target instanceof HTMLAnchorElement) contents.open = false;
  };
}
