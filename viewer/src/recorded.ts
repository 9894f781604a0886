// Recordings inside the page. How frames are coded is in src/page/frames.hpp.
import { ContactChunk, type ContactSteps, type VisitContact } from './contacts';
import { type FrameSource, type Kind, type MeshLevel, type Poses, type Run } from './data';

interface Chunk {
  frames: number;
  widths: number[];
}

interface Head extends Run, ContactSteps {
  times: number[];
  position_steps: number;
  quaternion_steps: number;
  angle_steps: number;
  enabled: boolean;
  joints_enabled: boolean;
  chunks: Chunk[];
}

// Channels of a kind in a decoded chunk, each [frame][item].
interface Decoded {
  positions: Int32Array[];
  turns: Int32Array[];
  speed: Int32Array;
  spin: Int32Array;
  status: Int32Array;
  there: Int32Array | null;
  joints: Int32Array | null; // [frame][world][joint]
  contacts: ContactChunk | null;
}

const MAX_CHUNKS = 24; // decoded, kept
const MAX_CONTACTS = 4; // of them, with their contacts

export function bytesOf(text: string): Uint8Array {
  const binary = atob(text);
  const out = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) out[i] = binary.charCodeAt(i);
  return out;
}

export async function inflate(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export function floats(text: unknown): Float32Array {
  return new Float32Array(bytesOf(text as string).buffer);
}

// Makes arrays of what meshes have as text.
export function openMeshes(run: Run): void {
  for (const mesh of run.meshes) {
    mesh.levels = mesh.levels.map((level): MeshLevel => ({
      points: floats(level.points),
      normals: floats(level.normals),
      triangles: new Uint32Array(bytesOf(level.triangles as unknown as string).buffer),
      lines: floats(level.lines),
      marks: floats(level.marks),
    }));
  }
}

// One channel: whole numbers of `items` over `frames`, from bytes that begin at `at`.
function decodeChannel(
  bytes: Uint8Array, at: number, width: number, items: number, frames: number): Int32Array {
  const count = items * frames;
  const out = new Int32Array(count);
  if (width === 0 || count === 0) return out;
  for (let item = 0, i = 0; item < items; ++item) {
    let one = 0;
    let two = 0;
    for (let frame = 0; frame < frames; ++frame, ++i) {
      let folded = bytes[at + i];
      if (width > 1) folded |= bytes[at + count + i] << 8;
      if (width > 2) folded |= bytes[at + 2 * count + i] << 16;
      if (width > 3) folded |= bytes[at + 3 * count + i] << 24;
      const left = (folded >>> 1) ^ -(folded & 1);
      const value = frame === 0 ? left : (2 * one - two + left) | 0;
      two = frame === 0 ? value : one;
      one = value;
      out[frame * items + item] = value;
    }
  }
  return out;
}

export class RecordedSource implements FrameSource {
  readonly frames: number;
  private readonly decoded = new Map<number, Decoded[]>();
  private readonly pending = new Map<number, Promise<void>>();
  private readonly first: number[] = []; // frame of each chunk
  private readonly steps: Float32Array[]; // m, of each row, per kind

  private constructor(readonly run: Head, private readonly textOf: (chunk: number) => string) {
    this.frames = run.times.length;
    let frame = 0;
    for (const chunk of run.chunks) {
      this.first.push(frame);
      frame += chunk.frames;
    }
    this.steps = run.kinds.map((kind) => {
      const steps = new Float32Array(kind.rows);
      for (const body of kind.bodies) {
        if (body.row !== null) steps[body.row] = body.radius / run.position_steps;
      }
      return steps;
    });
  }

  // Makes arrays of what a head has as text.
  static async open(head: unknown, textOf: (chunk: number) => string): Promise<RecordedSource> {
    const run = head as Head;
    openMeshes(run);
    const packed = async (text: unknown) =>
      new Float32Array((await inflate(bytesOf(text as string))).buffer);
    for (const kind of run.kinds) {
      for (const one of kind.sizes) one.values = await packed(one.values);
    }
    for (const number of run.numbers) number.values = await packed(number.values);
    return new RecordedSource(run, textOf);
  }

  time(frame: number): number {
    return this.run.times[frame];
  }

  private chunkOf(frame: number): number {
    let low = 0;
    let high = this.first.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.first[middle] <= frame) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  ready(frame: number): boolean {
    return this.decoded.has(this.chunkOf(frame));
  }

  prepare(frame: number): Promise<void> {
    const index = this.chunkOf(Math.max(0, Math.min(frame, this.frames - 1)));
    if (this.decoded.has(index)) return Promise.resolve();
    let work = this.pending.get(index);
    if (work === undefined) {
      work = inflate(bytesOf(this.textOf(index))).then((bytes) => {
        this.decoded.set(index, this.decode(this.run.chunks[index], bytes));
        this.pending.delete(index);
        // The oldest goes; a Map keeps the order in which they came.
        for (const key of this.decoded.keys()) {
          if (this.decoded.size <= MAX_CHUNKS) break;
          this.decoded.delete(key);
        }
      });
      this.pending.set(index, work);
    }
    return work;
  }

  private decode(chunk: Chunk, bytes: Uint8Array): Decoded[] {
    const planar = this.run.space === 'planar';
    let at = 0;
    let channel = 0;
    const next = (items: number) => {
      const width = chunk.widths[channel++];
      const out = decodeChannel(bytes, at, width, items, chunk.frames);
      at += width * items * chunk.frames;
      return out;
    };
    const contactsOf = (worlds: number) => {
      const counts = next(worlds);
      const points = counts.reduce((sum, count) => sum + count, 0);
      const channels = Array.from({ length: ContactChunk.channels(planar) }, () => {
        const width = chunk.widths[channel++];
        const from = at;
        at += width * points;
        return { at: from, width };
      });
      return new ContactChunk(bytes, counts, channels, chunk.frames, planar);
    };
    const space = planar ? 2 : 3;
    return this.run.kinds.map((kind) => {
      const items = kind.worlds * kind.rows;
      const turns = kind.orientation === 2 ? 1 : kind.orientation;
      return {
        positions: Array.from({ length: space }, () => next(items)),
        turns: Array.from({ length: turns }, () => next(items)),
        speed: next(items),
        spin: next(items),
        status: next(kind.worlds),
        there: this.run.enabled ? next(items) : null,
        joints: this.run.joints_enabled ? next(kind.worlds * kind.joints.length) : null,
        contacts: this.run.contacts === true ? contactsOf(kind.worlds) : null,
      };
    });
  }

  read(frame: number, part: number, kindIndex: number, into: Poses): void {
    const kind = this.run.kinds[kindIndex];
    const items = kind.worlds * kind.rows;
    const chunkA = this.chunkOf(frame);
    const a = this.decoded.get(chunkA)?.[kindIndex];
    if (a === undefined) throw new Error(`frame ${frame} was not prepared`);
    const next = Math.min(frame + 1, this.frames - 1);
    const chunkB = this.chunkOf(next);
    const b = part > 0 ? this.decoded.get(chunkB)?.[kindIndex] : a;
    const atA = (frame - this.first[chunkA]) * items;
    if (b === undefined) throw new Error(`frame ${next} was not prepared`);
    const atB = part > 0 ? (next - this.first[chunkB]) * items : atA;
    const steps = this.steps[kindIndex];
    const { position, rotation } = into;
    for (let c = 0; c < a.positions.length; ++c) {
      const from = a.positions[c];
      const to = b.positions[c];
      for (let i = 0, row = 0; i < items; ++i) {
        const x = from[atA + i];
        position[3 * i + c] = (x + part * (to[atB + i] - x)) * steps[row];
        if (++row === kind.rows) row = 0;
      }
    }
    if (kind.orientation === 4) {
      const [aw, ax, ay, az] = a.turns;
      const [bw, bx, by, bz] = b.turns;
      for (let i = 0; i < items; ++i) {
        const p = atA + i;
        const q = atB + i;
        let w = aw[p], x = ax[p], y = ay[p], z = az[p];
        // Frames of different chunks may have chosen different signs.
        const sign = w * bw[q] + x * bx[q] + y * by[q] + z * bz[q] < 0 ? -part : part;
        w = (1 - part) * w + sign * bw[q];
        x = (1 - part) * x + sign * bx[q];
        y = (1 - part) * y + sign * by[q];
        z = (1 - part) * z + sign * bz[q];
        const scale = 1 / (Math.sqrt(w * w + x * x + y * y + z * z) || 1);
        rotation[4 * i] = x * scale;
        rotation[4 * i + 1] = y * scale;
        rotation[4 * i + 2] = z * scale;
        rotation[4 * i + 3] = w * scale;
      }
    } else {
      const angles = kind.orientation === 2 ? a.turns[0] : null;
      const toAngles = kind.orientation === 2 ? b.turns[0] : null;
      const half = Math.PI / this.run.angle_steps;
      for (let i = 0; i < items; ++i) {
        let angle = 0;
        if (angles !== null && toAngles !== null) {
          const x = angles[atA + i];
          angle = (x + part * (toAngles[atB + i] - x)) * half;
        }
        rotation[4 * i] = rotation[4 * i + 1] = 0;
        rotation[4 * i + 2] = Math.sin(angle);
        rotation[4 * i + 3] = Math.cos(angle);
      }
    }
    for (let i = 0; i < items; ++i) {
      into.speed[i] = a.speed[atA + i];
      into.spin[i] = a.spin[atA + i];
      into.there[i] = a.there === null ? 1 : a.there[atA + i];
    }
    if (a.joints !== null) {
      const joints = kind.worlds * kind.joints.length;
      const from = (frame - this.first[chunkA]) * joints;
      into.joints.set(a.joints.subarray(from, from + joints));
    }
    const atStatus = (frame - this.first[chunkA]) * kind.worlds;
    for (let w = 0; w < kind.worlds; ++w) into.status[w] = a.status[atStatus + w];
  }

  visitContacts(frame: number, kindIndex: number, world: number, visit: VisitContact): void {
    const chunk = this.chunkOf(frame);
    const contacts = this.decoded.get(chunk)?.[kindIndex].contacts ?? null;
    if (contacts === null) return;
    if (!contacts.decoded) this.forgetContacts();
    contacts.visit(frame - this.first[chunk], world, this.run.kinds[kindIndex], this.run, visit);
  }

  // Those of the oldest chunks, so that there is room for one more.
  private forgetContacts(): void {
    const decoded = [...this.decoded.values()].flat().map((one) => one.contacts).filter((one) => one?.decoded);
    decoded.slice(0, Math.max(0, decoded.length - MAX_CONTACTS * this.run.kinds.length + 1)).forEach((one) => one!.forget());
  }

  positionAt(frame: number, kindIndex: number, item: number, out: number[]): boolean {
    const chunk = this.chunkOf(frame);
    const one = this.decoded.get(chunk)?.[kindIndex];
    if (one === undefined) return false;
    const kind: Kind = this.run.kinds[kindIndex];
    const at = (frame - this.first[chunk]) * kind.worlds * kind.rows + item;
    const step = this.steps[kindIndex][item % kind.rows];
    out[2] = 0;
    one.positions.forEach((channel, c) => { out[c] = channel[at] * step; });
    return true;
  }
}

// All runs inside the page.
export async function openRuns(page: Document): Promise<{ title: string; sources: RecordedSource[] }> {
  const text = page.getElementById('mw-head')?.textContent;
  if (text === null || text === undefined) {
    throw new Error('This page has no recording. Create a page with manyworlds view.');
  }
  const head = JSON.parse(text) as { title: string; runs: unknown[] };
  const sources = await Promise.all(head.runs.map((run, r) =>
    RecordedSource.open(run, (chunk) => page.getElementById(`mw-${r}-${chunk}`)?.textContent ?? '')));
  return { title: head.title, sources };
}
