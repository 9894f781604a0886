// In which colour a body is drawn: its own, or that of a number on a scale.
import { weightOf } from './contacts';
import { LOST_COLOR, linear, scaleInto, type Rgb } from './colors';
import { LOST, speedOf, type FrameSource, type Poses } from './data';
import type { Drawable, KindView } from './drawables';
import type { Cell, Layout } from './layout';

export type ColorBy = string; // 'body', 'speed', ..., or 'number:NAME'

export interface Theme {
  ground: string;
  wall: string;
  tile: string;
  lost: string;
  selected: string;
  fixed: string;
  metal: string; // of joints, as the next
  rope: string;
}

// Coloring quantities of bodies, with their names.
export function colorChoices(sources: FrameSource[]): [ColorBy, string][] {
  const out: [ColorBy, string][] =
    [['body', 'body'], ['speed', 'speed'], ['spin', 'angular speed'], ['rest', 'rest and motion'], ['height', 'height']];
  if (hasContacts(sources)) out.push(['contact', 'contact force']);
  if (sources.length > 1) out.push(['run', 'recording']);
  for (const { name } of sources[0].run.numbers) out.push([`number:${name}`, name]);
  return out;
}

export function hasContacts(sources: FrameSource[]): boolean {
  return sources.some((source) => source.run.contacts === true);
}

// What colours of numbers mean.
export interface Scale {
  name: string;
  unit: string;
  at(x: number): number; // the number at 0 <= x <= 1
}

const LOST_RGB = linear(LOST_COLOR);
const REST_COLOR = '#5b6f8f';
const AWAKE_COLOR = '#f3a712';
const RUN_COLORS = ['#3f6fb5', '#f3a712', '#76b041', '#8f5aa8'];
const REST = linear(REST_COLOR);
const AWAKE = linear(AWAKE_COLOR);
const RUNS = RUN_COLORS.map(linear);

export function put(color: Rgb, out: Float32Array, at: number): void {
  out[at] = color[0];
  out[at + 1] = color[1];
  out[at + 2] = color[2];
}

export class Coloring {
  by: ColorBy = 'body';
  maxSpeed = 1; // ends of the scales, of what is shown
  maxSpin = 1;
  maxForce: number;
  private readonly weight: number; // N, of a body in the mean
  readonly tints: Record<keyof Theme, Rgb> =
    { ground: [1, 1, 1], wall: [1, 1, 1], tile: [1, 1, 1], lost: [1, 0, 0], selected: [0, 0, 1], fixed: [0.5, 0.5, 0.5], metal: [0.3, 0.3, 0.3], rope: [0.4, 0.3, 0.2] };
  private mode = 'body'; // `by` without the name of the number
  private numbers: { now: Float32Array; low: number; high: number } = { now: new Float32Array(0), low: 0, high: 0 };

  constructor(private readonly sources: FrameSource[], private readonly planar: boolean, private readonly layout: Layout) {
    this.weight = Math.max(...sources.flatMap((source) => source.run.kinds.map(weightOf)));
    this.maxForce = this.weight;
  }

  setTheme(theme: Theme): void {
    for (const name of Object.keys(theme) as (keyof Theme)[]) this.tints[name] = linear(theme[name]);
  }

  // Colour of a body as the eye gets it without shading, linear.
  into(cell: Cell, poses: Poses, drawable: Drawable, item: number, out: Float32Array, at: number): void {
    if (drawable.row < 0) {
      put(this.tints.fixed, out, at);
      return;
    }
    switch (this.mode) {
      case 'speed':
        scaleInto(speedOf(this.sources[cell.run].run, poses.speed[item]) / this.maxSpeed, out, at);
        break;
      case 'spin':
        scaleInto(speedOf(this.sources[cell.run].run, poses.spin[item]) / this.maxSpin, out, at);
        break;
      case 'contact':
        scaleInto(Math.log1p(poses.force[item] / this.weight) / Math.log1p(this.maxForce / this.weight), out, at);
        break;
      case 'rest':
        put(poses.speed[item] === 0 && poses.spin[item] === 0 ? REST : AWAKE, out, at);
        break;
      case 'height': {
        const up = this.planar ? 1 : 2;
        const x = poses.position[3 * item + up];
        scaleInto((x - this.layout.low[up]) / (this.layout.high[up] - this.layout.low[up]), out, at);
        break;
      }
      case 'run':
        put(RUNS[cell.run % RUNS.length], out, at);
        break;
      case 'number':
        scaleInto(this.numberOf(cell), out, at);
        break;
      default:
        put(drawable.color, out, at);
    }
    if ((poses.status[cell.world] & LOST) !== 0) {
      for (let c = 0; c < 3; ++c) out[at + c] = 0.25 * out[at + c] + 0.75 * LOST_RGB[c];
    }
  }

  private get number(): Float32Array | undefined {
    return this.sources[0].run.numbers.find((one) => `number:${one.name}` === this.by)?.values;
  }

  // Where the scale of the recorded number ends at this frame.
  findNumberEnds(frame: number): void {
    this.mode = this.by.startsWith('number:') ? 'number' : this.by;
    const values = this.number;
    if (values === undefined) return;
    const worlds = this.sources[0].run.kinds.reduce((sum, kind) => sum + kind.worlds, 0);
    const now = values.subarray(frame * worlds, (frame + 1) * worlds);
    let low = Infinity;
    let high = -Infinity;
    for (const x of now) {
      if (x < low) low = x;
      if (x > high) high = x;
    }
    this.numbers = { now, low, high };
  }

  // 0 to 1 of the recorded number of a world; the other recordings have none.
  private numberOf(cell: Cell): number {
    if (cell.run > 0) return 0;
    const first = this.sources[0].run.kinds.slice(0, cell.kind).reduce((sum, kind) => sum + kind.worlds, 0);
    const { now, low, high } = this.numbers;
    return (now[first + cell.world] - low) / (high - low || 1);
  }

  // Null if colours do not show a value.
  get scale(): Scale | null {
    const between = (name: string, unit: string, low: number, high: number): Scale => ({ name, unit, at: (x) => low + x * (high - low) });
    switch (this.by) {
      case 'speed': return between('speed', 'm/s', 0, this.maxSpeed);
      case 'spin': return between('angular speed', 'rad/s', 0, this.maxSpin);
      case 'height': {
        const up = this.planar ? 1 : 2;
        return between('height', 'm', this.layout.low[up], this.layout.high[up]);
      }
      case 'contact': {
        const most = Math.log1p(this.maxForce / this.weight);
        return { name: 'contact force', unit: 'N', at: (x) => this.weight * Math.expm1(x * most) };
      }
      default: {
        const number = this.sources[0].run.numbers.find((one) => `number:${one.name}` === this.by);
        return number === undefined ? null : between(number.name, number.unit, this.numbers.low, this.numbers.high);
      }
    }
  }

  // Meaning of single colours; null if they have none.
  get words(): { text: string; color: string }[] | null {
    if (this.by === 'rest') return [{ text: 'at rest', color: REST_COLOR }, { text: 'moving', color: AWAKE_COLOR }];
    if (this.by !== 'run') return null;
    return this.sources.map((_, r) => ({ text: `recording ${r + 1}`, color: RUN_COLORS[r % RUN_COLORS.length] }));
  }

  // The ends of the scales: the fastest body of this moment, but never less than before.
  widen(kinds: KindView[][]): void {
    this.sources.forEach((source, r) => kinds[r].forEach((view) => {
      let speed = 0;
      let spin = 0;
      for (const code of view.poses.speed) if (code > speed) speed = code;
      for (const code of view.poses.spin) if (code > spin) spin = code;
      for (const force of view.poses.force) if (force > this.maxForce) this.maxForce = force;
      this.maxSpeed = Math.max(this.maxSpeed, speedOf(source.run, speed));
      this.maxSpin = Math.max(this.maxSpin, speedOf(source.run, spin));
    }));
  }
}
