// Contacts of recordings inside the page. How they are coded is in src/page/contacts.hpp.
import type { Kind } from './data';

// A contact point: bodies of the scene; m, as the world has it, z is 0 in the plane; unit, from a to b; N.
export type VisitContact = (
  a: number, b: number, x: number, y: number, z: number, nx: number, ny: number, nz: number, force: number) => void;

export interface ContactSteps {
  normal_steps: number;
  force_steps: number;
  least_force: number; // N
}

interface Channel {
  at: number;
  width: number;
}

// Of one kind in one chunk; its lists are decoded when they are first asked for.
export class ContactChunk {
  private readonly start: Int32Array; // [world][frame], where its points begin
  private numbers: Int32Array[] | null = null; // of each channel, [point]

  // counts: [frame][world]. The lists lie in `bytes` from `at` on.
  constructor(private readonly bytes: Uint8Array, counts: Int32Array, private readonly channels: Channel[],
    private readonly frames: number, private readonly planar: boolean) {
    const worlds = counts.length / frames;
    this.start = new Int32Array(worlds * frames + 1);
    for (let world = 0, i = 0; world < worlds; ++world) {
      for (let frame = 0; frame < frames; ++frame, ++i) this.start[i + 1] = this.start[i] + counts[frame * worlds + world];
    }
  }

  static channels(planar: boolean): number {
    return planar ? 7 : 9;
  }
  get points(): number {
    return this.start[this.start.length - 1];
  }
  get decoded(): boolean {
    return this.numbers !== null;
  }
  forget(): void {
    this.numbers = null;
  }

  visit(frame: number, world: number, kind: Kind, steps: ContactSteps, visit: VisitContact): void {
    this.numbers ??= this.decode();
    const n = this.numbers;
    const step = kind.contact_step ?? 0;
    const one = 1 / steps.normal_steps;
    const i = world * this.frames + frame;
    for (let p = this.start[i]; p < this.start[i + 1]; ++p) {
      const force = n[n.length - 1][p] === 0 ? 0 : steps.least_force * 2 ** ((n[n.length - 1][p] - 1) / steps.force_steps);
      if (this.planar) visit(n[0][p], n[1][p], n[2][p] * step, n[3][p] * step, 0, n[4][p] * one, n[5][p] * one, 0, force);
      else visit(n[0][p], n[1][p], n[2][p] * step, n[3][p] * step, n[4][p] * step, n[5][p] * one, n[6][p] * one, n[7][p] * one, force);
    }
  }

  // What is left of numbers, made whole: worlds and their frames come one after the other.
  private decode(): Int32Array[] {
    const out = this.channels.map(({ at, width }) => unfold(this.bytes, at, width, this.points));
    const [a, b] = out;
    for (let list = 0; list + 1 < this.start.length; ++list) {
      const begin = this.start[list];
      const first = list % this.frames === 0;
      const before = first ? begin : this.start[list - 1];
      let next = before;
      for (let p = begin; p < this.start[list + 1]; ++p) {
        const same = before + p - begin;
        if (same < begin) {
          a[p] += a[same];
          b[p] += b[same];
        }
        while (next < begin && (a[next] < a[p] || (a[next] === a[p] && b[next] < b[p]))) ++next;
        if (next < begin && a[next] === a[p] && b[next] === b[p]) {
          for (let c = 2; c < out.length; ++c) out[c][p] += out[c][next];
          ++next;
        }
      }
    }
    return out;
  }
}

function unfold(bytes: Uint8Array, at: number, width: number, count: number): Int32Array {
  const out = new Int32Array(count);
  for (let i = 0; i < count; ++i) {
    let folded = 0;
    for (let b = 0; b < width; ++b) folded |= bytes[at + b * count + i] << (8 * b);
    out[i] = (folded >>> 1) ^ -(folded & 1);
  }
  return out;
}

// N, what bodies of a kind weigh in the mean: what forces are measured by.
export function weightOf(kind: Kind): number {
  const moving = kind.bodies.filter((body) => body.motion === 'dynamic' && body.mass > 0);
  const mass = moving.reduce((sum, body) => sum + body.mass, 0) / (moving.length || 1) || 1;
  return mass * (Math.hypot(...kind.gravity) || 9.81);
}
