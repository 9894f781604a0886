// Comparison with other engines.
import * as Plot from '@observablehq/plot';
import type { PeerEngine, PeerErrors, PeerScene, Throughput } from './data';
import { distinct, make, table, type Cell } from './dom';
import { section } from './frame';
import { length, perSecond, short } from './numbers';
import { colorOf, figure, legend, logScale, plot, swatch } from './plots';

const OWN = 'manyworlds';

function errorText({ worst_overlap_m: overlap, worst_gap_m: gap }: PeerErrors): string {
  if (gap !== null) return `gap ${length(gap)}`;
  return overlap !== null ? `overlap ${length(overlap)}` : 'error unknown';
}

interface Speed {
  scene: string;
  name: string;
  speed: number;
  ratio: number | null;
  errors: PeerErrors;
}

function picture(speeds: Speed[], names: string[]): HTMLElement[] {
  const scenes = distinct(speeds.map((s) => s.scene));
  const height = 60 + 30 * scenes.length;
  let hidden = new Set<string>();
  const color = (s: Speed): string => colorOf(names.indexOf(s.name));
  const chart = figure('Speed compared with other engines', height, (width) => {
    const seen = speeds.filter((s) => !hidden.has(s.name));
    const place = { x: 'speed', y: 'scene' };
    return plot(width, height, {
      marginLeft: 104, marginRight: 20, marginTop: 6, marginBottom: 42,
      x: logScale(speeds.map((s) => s.speed), { label: 'world-steps per second', format: perSecond, room: width - 104, each: 62 }),
      y: { type: 'band', domain: scenes, label: null, tickSize: 0, grid: true },
      marks: [
        Plot.dot(seen, { ...place, fill: color, r: (s: Speed) => (s.name === OWN ? 6 : 4.5) }),
      ],
      r: { type: 'identity' },
    }, {
      data: seen, place, fields: [
        ['scene', (s) => s.scene], ['engine', (s) => s.name], ['speed', (s) => perSecond(s.speed)],
        ['manyworlds / engine', (s) => (s.ratio === null ? '' : `${short(s.ratio)} x`)], ['worst', (s) => errorText(s.errors)]],
    });
  });
  return [chart.element, legend([names.map((name, i) => ({ name, swatch: swatch(colorOf(i), 'box') }))], (now) => {
    hidden = now;
    chart.redraw();
  })];
}

const speedCell = (speed: number, ratio: number, note: string): Cell => ({ text: `${perSecond(speed)} (${short(ratio)} x)`, note });

// A row for manyworlds in each scene and for each engine, the fastest first.
function rowsOf(scene: PeerScene, nameOf: (e: PeerEngine) => string): (string | Cell)[][] {
  return [
    [scene.scene, OWN, perSecond(scene.world_steps_per_s), perSecond(scene.long_visit), errorText(scene)],
    ...scene.engines.map((e): (string | Cell)[] => ['', nameOf(e),
      speedCell(e.world_steps_per_s, e.ratio, e.rounds === 1 ? 'once' : `median of ${e.rounds}`),
      e.long_visit ? speedCell(e.long_visit.world_steps_per_s, e.long_visit.ratio, '') : '', errorText(e)])];
}

export function peersSection({ peer_protocol: protocol, peer_means: means, peer_failures: failures = [] }: Throughput, peers: PeerScene[]): void {
  const nameOf = (e: { engine: string; version: string }): string => `${e.engine} ${e.version}`;
  const engines = distinct(peers.flatMap((s) => s.engines.map(nameOf)));
  const speeds = peers.flatMap((s): Speed[] => [
    { scene: s.scene, name: OWN, speed: s.world_steps_per_s, ratio: null, errors: s },
    ...s.engines.map((e) => ({ scene: s.scene, name: nameOf(e), speed: e.world_steps_per_s, ratio: e.ratio, errors: e }))]);
  const rounds = protocol ? (protocol.rounds === 1 ? 'once' : `median of ${protocol.rounds} rounds`) : '';
  const said = protocol ? `${protocol.worlds} worlds on one thread, ${protocol.steps} steps of 1/60 s after 60 warm-up steps, without sleep. Processor time, engines interleaved in one run, ${rounds}. ` : '';
  const visit = protocol?.long_visit ?? 16;
  const mean = means?.ratio ? `manyworlds is ${short(means.ratio)} times as fast as the fastest engine of each scene (geometric mean)` +
    (means.long_visit ? `, ${short(means.long_visit)} times with ${visit} steps per visit.` : '.') : '';
  section('Comparison with other engines', [
    mean === '' ? null : make('p', {}, mean),
    make('p', {}, `${said}World-steps per second with one step, and with ${visit} steps, per visit of a world. In parentheses: speed of manyworlds / speed of the ` +
      'engine, median of rounds with manyworlds before and after. Worst: the deepest overlap or widest joint gap of all worlds after the last step, computed ' +
      'by the same code from the poses of each engine. Engines slower than a third of the fastest one run once.'),
    failures.map((failure) => make('p', { class: 'fail' }, failure)),
    speeds.length > 0 ? picture(speeds, [OWN, ...engines]) : null,
    table(['scene', 'engine', 'world-steps', `${visit} per visit`, 'worst, last step'], peers.flatMap((scene) => rowsOf(scene, nameOf))),
    distinct(peers.flatMap((s) => s.engines.map((e) => `${nameOf(e)}: ${e.settings}.`))).map((note) => make('p', { class: 'quiet' }, note)),
  ], failures.length > 0 ? { tally: { passed: 0, failed: failures.length } } : {});
}
