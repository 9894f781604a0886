// Other engines beside manyworlds.
import * as Plot from '@observablehq/plot';
import type { PeerErrors, PeerScene, Throughput } from './data';
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
  const chart = figure('Speed beside other engines', height, (width) => {
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

export function peersSection({ peer_protocol: protocol, peer_failures: failures = [] }: Throughput, peers: PeerScene[]): void {
  const nameOf = (e: { engine: string; version: string }): string => `${e.engine} ${e.version}`;
  const engines = distinct(peers.flatMap((s) => s.engines.map(nameOf)));
  const rows = peers.map((scene): (string | Cell)[] => [scene.scene,
    { text: perSecond(scene.world_steps_per_s), note: errorText(scene) },
    ...engines.map((name): Cell => {
      const e = scene.engines.find((one) => nameOf(one) === name);
      return e ? { text: `${perSecond(e.world_steps_per_s)} (${short(e.ratio)} x)`, note: errorText(e) } : { text: '' };
    })]);
  const speeds = peers.flatMap((s): Speed[] => [
    { scene: s.scene, name: OWN, speed: s.world_steps_per_s, ratio: null, errors: s },
    ...s.engines.map((e) => ({ scene: s.scene, name: nameOf(e), speed: e.world_steps_per_s, ratio: e.ratio, errors: e }))]);
  const rounds = protocol ? (protocol.rounds === 1 ? 'once' : `median of ${protocol.rounds} rounds`) : '';
  const said = protocol ? `${protocol.worlds} worlds on one thread, round robin, ${protocol.steps} steps of 1/60 s after 60 to warm up, no sleep; in turns in one run, ${rounds}. ` : '';
  section('Beside other engines', [
    make('p', {}, `${said}World-steps per second, how often as fast manyworlds is (median of the rounds, each against manyworlds right before and after) in ` +
      'parentheses, and the deepest overlap or widest joint gap of all worlds after the last step.'),
    failures.map((failure) => make('p', { class: 'fail' }, failure)),
    speeds.length > 0 ? picture(speeds, [OWN, ...engines]) : null,
    table(['scene', OWN, ...engines], rows),
    distinct(peers.flatMap((s) => s.engines.map((e) => `${nameOf(e)}: ${e.settings}.`))).map((note) => make('p', { class: 'quiet' }, note)),
  ], failures.length > 0 ? { tally: { passed: 0, failed: failures.length } } : {});
}
