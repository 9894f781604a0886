// Frames of a running batch: the last few seconds of what its program sends, as far as this page asked for it.
import type { FrameSource, Kind, Poses, Run } from './data';
import { Link, TURN_STEPS, type LiveFrame, type Sized } from './link';
import { floats, openMeshes } from './recorded';

const KEPT = 150; // frames, for trails

interface Head extends Run {
  title: string;
  all_worlds: number;
  most_worlds: number;
  first_worlds: number;
  can: {
    clock: boolean;
    resets: boolean;
    gravity: { low: number[]; high: number[] } | null;
    friction: { low: number; high: number } | null;
  };
}

export class LiveSource implements FrameSource {
  readonly state = { paused: false, speed: 1, reached: 0, steps: 0, lost: 0, frames: 0 };
  changed: () => void = () => {};
  said: (text: string) => void = () => {};
  resized: () => void = () => {};
  gone: (why: string) => void = () => {};
  private history: { frame: LiveFrame; first: Map<number, number> }[] = [];
  private waiting = false; // for a frame that was asked for
  private asked = ''; // which worlds, at what rate
  private readonly place: { kind: number; world: number }[] = []; // of each world

  private constructor(readonly run: Head, readonly link: Link) {
    run.kinds.forEach((kind, k) => {
      for (let world = 0; world < kind.worlds; ++world) this.place[kind.first_world + world] = { kind: k, world };
    });
    link.planar = run.space === 'planar';
    link.turned = run.kinds.some((kind) => kind.orientation !== 0);
    link.listener = {
      frame: (frame) => this.take(frame),
      said: (text) => this.said(text),
      sizes: (kinds) => this.resize(kinds),
      gone: (why) => this.gone(why),
    };
  }

  static async open(): Promise<LiveSource> {
    const link = await Link.connect();
    const wanted = Number(new URLSearchParams(window.location.hash.slice(1)).get('worlds'));
    let head = (await link.open(1)) as Head;
    const worlds = Number.isInteger(wanted) && wanted > 0 ? Math.min(wanted, head.most_worlds) : head.first_worlds;
    if (worlds > 1) head = (await link.open(worlds)) as Head;
    openMeshes(head);
    for (const kind of head.kinds) for (const one of kind.sizes) one.values = floats(one.values);
    const source = new LiveSource(head, link);
    source.ask();
    await new Promise<void>((resolve) => {
      source.changed = resolve;
    });
    return source;
  }

  get frames(): number {
    return this.history.length;
  }
  time(frame: number): number {
    return this.history[frame]?.frame.time ?? 0;
  }
  ready(): boolean {
    return true;
  }
  prepare(): Promise<void> {
    return Promise.resolve();
  }

  // The next frame, when the last one was drawn: a page that is not looked at asks for none.
  ask(): void {
    if (this.waiting) return;
    this.waiting = true;
    this.link.send({ do: 'frame' });
  }

  // From now on these worlds alone.
  show(worlds: number[], fps: number): void {
    const message = JSON.stringify({ do: 'show', worlds, fps });
    if (message === this.asked) return;
    this.asked = message;
    this.link.send({ do: 'show', worlds, fps });
  }

  private take(frame: LiveFrame): void {
    this.waiting = false;
    const last = this.history.at(-1)?.frame;
    if (last !== undefined && frame.time < last.time) this.history = [];
    else if (last !== undefined && frame.time === last.time) this.history.pop();
    const first = new Map<number, number>();
    let body = 0;
    for (const world of frame.worlds) {
      first.set(world, body);
      body += this.run.kinds[this.place[world].kind].rows;
    }
    this.history.push({ frame, first });
    if (this.history.length > KEPT) this.history.shift();
    const { paused, speed, reached, steps, lost } = frame;
    Object.assign(this.state, { paused, speed, reached, steps, lost, frames: this.state.frames + 1 });
    this.changed();
  }

  private resize(kinds: Sized[][]): void {
    kinds.forEach((sizes, k) => {
      this.run.kinds[k].sizes = sizes.map(({ shape, values }) => ({ shape, values: floats(values) }));
    });
    this.resized();
  }

  // Poses of the worlds that the frame has; the others stay.
  read(index: number, _part: number, kindIndex: number, into: Poses): void {
    const { frame, first } = this.history[index];
    const kind = this.run.kinds[kindIndex];
    const joints = kind.joints.length;
    let joint = 0; // of this world, in the frame
    frame.worlds.forEach((world, w) => {
      const { kind: of, world: cell } = this.place[world];
      const from = joint;
      joint += this.run.kinds[of].joints.length;
      if (of !== kindIndex) return;
      into.joints.set(frame.joints.subarray(from, from + joints), cell * joints);
      into.status[cell] = frame.status[w];
      const body = first.get(world) as number;
      for (let row = 0; row < kind.rows; ++row) this.readBody(frame, kind, body + row, cell * kind.rows + row, into);
    });
  }

  private readBody(frame: LiveFrame, kind: Kind, from: number, item: number, into: Poses): void {
    const { positions, turns } = frame;
    const { position, rotation } = into;
    if (kind.orientation === 4) {
      for (let c = 0; c < 3; ++c) position[3 * item + c] = positions[3 * from + c];
      rotation[4 * item] = turns[4 * from + 1] / TURN_STEPS;
      rotation[4 * item + 1] = turns[4 * from + 2] / TURN_STEPS;
      rotation[4 * item + 2] = turns[4 * from + 3] / TURN_STEPS;
      rotation[4 * item + 3] = turns[4 * from] / TURN_STEPS;
    } else {
      const width = this.link.planar ? 2 : 3;
      for (let c = 0; c < 3; ++c) position[3 * item + c] = c < width ? positions[width * from + c] : 0;
      const turned = kind.orientation === 2;
      rotation[4 * item] = rotation[4 * item + 1] = 0;
      rotation[4 * item + 2] = turned ? turns[2 * from + 1] / TURN_STEPS : 0;
      rotation[4 * item + 3] = turned ? turns[2 * from] / TURN_STEPS : 1;
    }
    into.speed[item] = frame.speeds[from];
    into.spin[item] = frame.spins[from];
    into.there[item] = frame.there[from];
  }

  visitContacts(): void {}

  positionAt(index: number, kindIndex: number, item: number, out: number[]): boolean {
    const one = this.history[index];
    const kind = this.run.kinds[kindIndex];
    const world = Math.floor(item / kind.rows);
    const from = one?.first.get(kind.first_world + world);
    if (from === undefined) return false;
    const width = this.link.planar ? 2 : 3;
    out[2] = 0;
    for (let c = 0; c < width; ++c) out[c] = one.frame.positions[width * (from + (item % kind.rows)) + c];
    return true;
  }
}
